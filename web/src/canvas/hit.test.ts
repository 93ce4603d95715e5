import { expect, test } from "vitest";
import { emptyPose, withJoint } from "../model/pose";
import { jointAt } from "./hit";
import { toScreen } from "./view";

const view = { scale: 4, x: 30, y: -10 };
const pose = withJoint(withJoint(emptyPose(), 3, { x: 20, y: 20, v: 2 }), 4, { x: 21, y: 20, v: 1 });

test("a press finds the nearest placed joint, also an occluded one", () => {
  expect(jointAt(pose, view, toScreen(view, { x: 19.8, y: 20 }), 0)).toBe(3);
  expect(jointAt(pose, view, toScreen(view, { x: 21.3, y: 20 }), 0)).toBe(4);
});

test("joints without a place are never hit", () => {
  expect(jointAt(emptyPose(), { scale: 1, x: 0, y: 0 }, { x: 0.5, y: 0.5 }, 0)).toBe(-1);
  expect(jointAt(pose, view, { x: 500, y: 500 }, 0)).toBe(-1);
});

test("an outside joint can be found where it was", () => {
  const outside = withJoint(withJoint(pose, 7, { x: 60, y: 20, v: 0 }), 8, { x: -1, y: -1, v: 0 });
  expect(jointAt(outside, view, toScreen(view, { x: 60.5, y: 20 }), 0)).toBe(7);
  expect(jointAt(outside, view, toScreen(view, { x: -1, y: -1 }), 0)).toBe(-1);
});

test("between two joints the active one is taken", () => {
  expect(jointAt(pose, view, toScreen(view, { x: 20.5, y: 20 }), 4)).toBe(4);
});
