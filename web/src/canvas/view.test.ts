import { expect, test } from "vitest";
import { fitView, isInImage, panBy, toPixel, toScreen, zoomAt } from "./view";

const image = { width: 640, height: 480 };
const pane = { width: 1000, height: 600 };

test("the centre of the top-left pixel is (0, 0), half a pixel inside the drawn image", () => {
  const unscaled = { scale: 1, x: 0, y: 0 };
  expect(toScreen(unscaled, { x: 0, y: 0 })).toEqual({ x: 0.5, y: 0.5 });
  expect(toPixel(unscaled, { x: 0, y: 0 })).toEqual({ x: -0.5, y: -0.5 });
  expect(toScreen({ scale: 8, x: 100, y: 40 }, { x: 2, y: 3 })).toEqual({ x: 120, y: 68 });
});

test("screen and pixel are inverse to each other at any zoom", () => {
  const view = { scale: 3.7, x: -120.5, y: 44.25 };
  const pixel = { x: 123.25, y: 71.5 };
  const back = toPixel(view, toScreen(view, pixel));
  expect(back.x).toBeCloseTo(pixel.x, 9);
  expect(back.y).toBeCloseTo(pixel.y, 9);
});

test("an image is as wide as its pixels: the corners lie half a pixel beyond the outermost centres", () => {
  const view = fitView(image, pane);
  const from = toScreen(view, { x: -0.5, y: -0.5 });
  const to = toScreen(view, { x: 639.5, y: 479.5 });
  expect((to.x - from.x) / view.scale).toBeCloseTo(640, 9);
  expect(from.y).toBeCloseTo(8, 9);
  expect(to.y).toBeCloseTo(592, 9);
  expect(isInImage({ x: -0.5, y: 0 }, image)).toBe(true);
  expect(isInImage({ x: 639.5, y: 0 }, image)).toBe(false);
});

test("zooming keeps what is under the cursor", () => {
  const cursor = { x: 333, y: 222 };
  const view = fitView(image, pane);
  const before = toPixel(view, cursor);
  const after = toPixel(zoomAt(view, cursor, 2.5, 0.1), cursor);
  expect(after.x).toBeCloseTo(before.x, 9);
  expect(after.y).toBeCloseTo(before.y, 9);
});

test("panning never loses the image", () => {
  const view = panBy(fitView(image, pane), { x: 1e6, y: -1e6 }, image, pane);
  expect(view.x).toBeLessThan(pane.width);
  expect(view.y + view.scale * image.height).toBeGreaterThan(0);
});
