import { expect, test } from "vitest";
import { shapeHand } from "./liveHand";

const template = Float32Array.from([0, 0, 0, 1, 0, 0]);
/** Component 0 moves the first vertex along x, component 1 the second along z. */
const directions = Float32Array.from([1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2]);

test("components add up, each by its own weight, and the template stays as it was", () => {
  expect([...shapeHand(template, directions, 2, [3, -1])]).toEqual([3, 0, 0, 1, 0, -2]);
  expect([...template]).toEqual([0, 0, 0, 1, 0, 0]);
});

test("what is not given is the mean, and what the model does not have is left aside", () => {
  expect([...shapeHand(template, directions, 2, [])]).toEqual([...template]);
  expect([...shapeHand(template, directions, 2, [0, 0, 7])]).toEqual([...template]);
});
