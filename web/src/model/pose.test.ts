import { expect, test } from "vitest";
import { JOINTS, EDGES, fingerOf } from "./joints";
import { emptyPose, fromWire, keyText, parseKey, statusOf, toWire, withJoint, withStatus } from "./pose";

test("a hand has 21 joints and 20 lines that make a tree from the wrist", () => {
  expect(JOINTS).toHaveLength(21);
  expect(new Set(JOINTS).size).toBe(21);
  expect(new Set(EDGES.map(([, child]) => child)).size).toBe(20);
  expect(EDGES.every(([parent, child]) => parent < child)).toBe(true);
  expect(EDGES.every(([parent, child]) => parent === 0 || fingerOf(parent) === fingerOf(child))).toBe(true);
});

test("every status survives the way to the server and back", () => {
  let pose = emptyPose();
  pose = withJoint(pose, 3, { x: 10.25, y: 0.5, v: 2 });
  pose = withJoint(pose, 4, { x: 11, y: 12, v: 1 });
  pose = withJoint(pose, 5, withStatus({ x: 7, y: 8, v: 2 }, "outside"));
  pose = withJoint(pose, 6, withStatus({ x: 0, y: 0, v: 0 }, "outside"));
  const back = fromWire(toWire(pose));
  expect(back).toEqual(pose);
  expect(back.map(statusOf).slice(2, 8)).toEqual(["unset", "visible", "occluded", "outside", "outside", "unset"]);
});

test("a joint that went outside comes back where it was", () => {
  const point = { x: 40, y: 50, v: 2 } as const;
  expect(withStatus(withStatus(point, "outside"), "visible")).toEqual(point);
});

test("a key keeps any camera name", () => {
  const key = { camera: "front|left cam", frame: 12, hand: "left" } as const;
  expect(parseKey(keyText(key))).toEqual(key);
});
