import { expect, test } from "vitest";
import { frameAt, panWindow, tickStep, wholeWindow, windowWith, xOf, zoomWindow } from "./frameWindow";

test("zooming keeps the frame under the pointer, and stops at both ends", () => {
  const whole = wholeWindow(1500);
  const near = zoomWindow(whole, 4, 0.5, 1500);
  expect([near.count, near.from]).toEqual([375, 562.5]);
  expect(xOf(near, 1000, 750)).toBeCloseTo(500);
  expect(zoomWindow(near, 1e9, 0.2, 1500).count).toBe(24);
  expect(zoomWindow(near, 1e-9, 0.2, 1500)).toEqual(whole);
  expect(zoomWindow(wholeWindow(8), 4, 0.5, 8)).toEqual(wholeWindow(8));
});

test("a pixel is a frame, whatever is shown", () => {
  const near = zoomWindow(wholeWindow(1500), 10, 0, 1500);
  expect(frameAt(near, 1000, xOf(near, 1000, 77) + 0.01, 1500)).toBe(77);
  expect([frameAt(near, 1000, -50, 1500), frameAt(wholeWindow(1500), 1000, 5000, 1500)]).toEqual([0, 1499]);
});

test("the window turns the page when the frame leaves it", () => {
  const near = zoomWindow(wholeWindow(1500), 10, 0, 1500);
  expect(windowWith(near, 149, 1500)).toBe(near);
  expect(windowWith(near, 150, 1500).from).toBe(135);
  expect(windowWith(panWindow(near, 500, 1500), 499, 1500).from).toBe(499 - 150 + 15);
  expect(windowWith(near, 1499, 1500).from).toBe(1350);
});

test("frame numbers are round and never crowded", () => {
  expect([tickStep(wholeWindow(1500), 1000), tickStep(wholeWindow(20), 1000), tickStep(wholeWindow(16), 1000)]).toEqual([200, 2, 2]);
});
