import { expect, it } from "vitest";
import { pinch, swipeOf } from "./pinch";
import { fitView, toPixel } from "./view";

const image = { width: 640, height: 480 };
const pane = { width: 390, height: 400 };

it("keeps what is under the fingers under them", () => {
  const view = fitView(image, pane);
  const [before, after] = [
    [{ x: 150, y: 180 }, { x: 250, y: 220 }],
    [{ x: 100, y: 160 }, { x: 300, y: 240 }],
  ] as const;
  const zoomed = pinch(view, before, after, image, pane);
  expect(zoomed?.scale).toBeCloseTo(2 * view.scale);
  for (const place of [0, 1] as const) {
    const [was, is] = [toPixel(view, before[place]), toPixel(zoomed ?? view, after[place])];
    expect(is.x).toBeCloseTo(was.x);
    expect(is.y).toBeCloseTo(was.y);
  }
});

it("fits a picture that would be smaller than the pane", () => {
  const together = [{ x: 190, y: 200 }, { x: 200, y: 200 }] as const;
  expect(pinch(fitView(image, pane), [{ x: 100, y: 200 }, { x: 300, y: 200 }], together, image, pane)).toBeNull();
});

it("takes a finger drawn across for another frame, and nothing else", () => {
  expect(swipeOf({ x: 300, y: 200 }, { x: 200, y: 210 })).toBe(1);
  expect(swipeOf({ x: 100, y: 200 }, { x: 200, y: 190 })).toBe(-1);
  expect(swipeOf({ x: 100, y: 200 }, { x: 130, y: 200 })).toBe(0);
  expect(swipeOf({ x: 100, y: 200 }, { x: 160, y: 300 })).toBe(0);
});
