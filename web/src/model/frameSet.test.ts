import { expect, test } from "vitest";
import { nearestFrame, snapFrame, steppedFrame } from "./frameSet";

test("a frame outside of the set leads to the next one in the direction of travel", () => {
  const frames = [2, 5, 9];
  expect(snapFrame(frames, 5, 2)).toBe(5);
  expect(snapFrame(frames, 3, 2)).toBe(5);
  expect(snapFrame(frames, 4, 5)).toBe(2);
  expect(snapFrame(frames, 10, 9)).toBe(9);
  expect(snapFrame(frames, 1, 2)).toBe(2);
});

test("a step goes from frame to frame of the set and stops at its ends", () => {
  const frames = [2, 5, 9];
  expect(steppedFrame(frames, 9, -2)).toBe(2);
  expect(steppedFrame(frames, 2, 1)).toBe(5);
  expect(steppedFrame(frames, 5, 10)).toBe(9);
});

test("who comes from elsewhere is led to the nearest frame of the set", () => {
  expect(nearestFrame([2, 5, 9], 6)).toBe(5);
  expect(nearestFrame([2, 5, 9], 100)).toBe(9);
});
