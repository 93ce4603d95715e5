import { expect, test } from "vitest";
import { emptyPose, keyText, withJoint } from "../model/pose";
import { activateCamera } from "../actions/annotate/cameras";
import { createHoverStore, pointerOn } from "./pointer";
import { chooseShown } from "./shownCameras";

const cameras = Array.from({ length: 10 }, (_, k) => `cam${k}`);

test("the address comes before what is remembered, unknown cameras count for nothing, the recording's order holds", () => {
  expect(chooseShown(cameras, [["cam3", "cam1", "nonsense"], ["cam5"]], "cam1")).toEqual(["cam1", "cam3"]);
  expect(chooseShown(cameras, [["nonsense"], ["cam5", "cam2"]], "cam5")).toEqual(["cam2", "cam5"]);
  expect(chooseShown(cameras, [[], []], "cam0")).toEqual(["cam0", "cam1", "cam2", "cam3"]);
  expect(chooseShown(cameras, [cameras], "cam0")).toHaveLength(8);
});

test("the active camera is always shown; where one alone is shown, it is the active one", () => {
  expect(chooseShown(cameras, [["cam0", "cam1"]], "cam7")).toEqual(["cam0", "cam1", "cam7"]);
  expect(chooseShown(cameras, [["cam0"]], "cam7")).toEqual(["cam7"]);
  expect(chooseShown(cameras, [cameras.slice(0, 8)], "cam9")).toEqual([...cameras.slice(0, 7), "cam9"]);
});

test("another camera becomes active without the joint being lost, unless the hand is finished", () => {
  const state = { poses: {}, camera: "cam0", frame: 0, frameCount: 3, frames: null, hand: "right" as const, joint: 7, isChosen: false, draft: null };
  expect(activateCamera(state, "cam1")).toEqual({ ...state, camera: "cam1" });
  expect(activateCamera(state, "cam0")).toBe(state);
  const done = emptyPose().map(() => ({ x: 1, y: 2, v: 2 as const }));
  const begun = withJoint(emptyPose(), 0, { x: 3, y: 4, v: 1 });
  const finished = { ...state, joint: 20, poses: { [keyText({ camera: "cam0", frame: 0, hand: "right" })]: done, [keyText({ camera: "cam1", frame: 0, hand: "right" })]: begun } };
  expect(activateCamera(finished, "cam1").joint).toBe(1);
});

test("a pointer is in one camera's picture at a time", () => {
  const hover = createHoverStore();
  const [left, right] = [pointerOn(hover, "cam0"), pointerOn(hover, "cam1")];
  left.set({ x: 1, y: 2 }, "person");
  expect([left.get(), right.get()]).toEqual([{ x: 1, y: 2 }, null]);
  right.set(null, "person");
  expect(left.get()).toEqual({ x: 1, y: 2 });
  right.set({ x: 3, y: 4 }, "person");
  expect([left.get(), right.get()]).toEqual([null, { x: 3, y: 4 }]);
  right.set(null, "person");
  expect(hover.get()).toBeNull();
});
