import { expect, test } from "vitest";
import { emptyPose, statusOf, toWire } from "../../model/pose";
import { activePose, type AnnotatorState } from "../../state/annotator";
import { createStore } from "../../state/store";
import { createUndoStack } from "../../state/undo";
import { bringPose } from "./bring";
import { clearHand, clearJoint } from "./clear";
import { cancelDrag, dragHand, dragJoint, endDrag, nudgeJoint } from "./move";
import { activateCamera } from "./cameras";
import { clickedJoint, placeBeside, placeIn, placeJoint } from "./place";
import { goToFrame, selectFinger, selectJoint, stepJoint, switchHand } from "./select";
import { acceptAll } from "./accept";
import { propagateTo } from "./propagate";
import { camerasTouched } from "./touched";
import { cycleVisibility, toggleOccluded, toggleOutside } from "./visibility";

const start: AnnotatorState = {
  poses: {},
  camera: "cam0",
  frame: 0,
  frameCount: 10,
  frames: null,
  hand: "right",
  joint: 0,
  isChosen: false,
  draft: null,
};
const placed = (count: number, from = start): AnnotatorState =>
  Array.from({ length: count }).reduce<AnnotatorState>((state, _, k) => placeJoint(state, { x: 10 + k, y: 20 }), from);

test("21 clicks mark a hand, each going on to the next joint", () => {
  const state = placed(21);
  expect(activePose(state).every((point) => point.v === 2)).toBe(true);
  expect(activePose(state)[7]).toEqual({ x: 17, y: 20, v: 2 });
  expect(state.joint).toBe(20);
});

test("a click skips joints that are already decided", () => {
  const state = placed(1, selectJoint(toggleOutside(selectJoint(start, 1)), 0));
  expect(state.joint).toBe(2);
});

test("a drag is one change, and calling it off leaves nothing", () => {
  const state = placed(3);
  const dragged = dragJoint(dragJoint(state, { joint: 1, to: { x: 90, y: 91 } }), { joint: 1, to: { x: 92, y: 93 } });
  expect(dragged.poses).toBe(state.poses);
  expect(cancelDrag(dragged).poses).toBe(state.poses);
  expect(activePose(endDrag(dragged))[1]).toEqual({ x: 92, y: 93, v: 2 });
});

test("Alt+drag moves every placed joint and no other", () => {
  const state = placed(2);
  const moved = activePose(endDrag(dragHand(state, { x: 5, y: -5 })));
  expect(moved[0]).toEqual({ x: 15, y: 15, v: 2 });
  expect(moved[2]).toEqual(emptyPose()[2]);
});

test("right click goes visible, occluded, outside, visible, and keeps the place", () => {
  const states = [placed(1)];
  for (let k = 0; k < 3; k += 1) states.push(cycleVisibility(states.at(-1)!, 0));
  expect(states.map((state) => statusOf(activePose(state)[0]))).toEqual(["visible", "occluded", "outside", "visible"]);
  expect(activePose(states[3]!)[0]).toEqual({ x: 10, y: 20, v: 2 });
});

test("a click on the ground moves no joint of a finished hand, unless somebody chose it", () => {
  const done = placed(21);
  const stray = { x: 300, y: 300 };
  expect(clickedJoint(done)).toBeNull();
  for (const place of Object.values(placeIn)) expect(place(done, stray)).toBe(done);
  const chosen = stepJoint(done, 1);
  expect([clickedJoint(chosen), activePose(placeJoint(chosen, stray))[0]]).toEqual([0, { ...stray, v: 2 }]);
  expect(clickedJoint(placeJoint(chosen, stray)), "one click, one joint").toBeNull();
  expect(clickedJoint(placeIn.stay(chosen, stray)), "where clicks stay with a joint, they do").toBe(0);
  expect(clickedJoint(goToFrame(goToFrame(chosen, 1), 0)), "elsewhere meanwhile").toBeNull();
  expect(clickedJoint(switchHand(switchHand(chosen)))).toBeNull();
});

test("after a drag the next click goes on with the first open joint behind it", () => {
  const state = endDrag(dragJoint(placed(4), { joint: 1, to: { x: 90, y: 91 } }));
  expect([state.joint, clickedJoint(state)]).toEqual([1, 4]);
  expect(activePose(placeJoint(state, { x: 5, y: 6 })).slice(1, 5).map(({ x }) => x)).toEqual([90, 12, 13, 5]);
});

test("a right click on an outside joint that never had a place makes it open again, and removes an annotation of nothing else", () => {
  const out = toggleOutside(selectJoint(start, 4));
  expect(statusOf(activePose(out)[4])).toBe("outside");
  expect(cycleVisibility(out, 4)).toMatchObject({ poses: {}, joint: 4 });
  const back = cycleVisibility(toggleOutside(selectJoint(placed(2), 4)), 4);
  expect([statusOf(activePose(back)[4]), statusOf(activePose(back)[0])]).toEqual(["unset", "visible"]);
});

test("a change of labels needs the pictures it is made in and about, whatever else it changes", () => {
  const both = placed(1, activateCamera(placed(1), "cam1"));
  const touched = (next: AnnotatorState, from = both): string[] => [...camerasTouched(from, next)].sort();
  expect(touched(goToFrame(both, 3))).toEqual([]);
  expect(touched(selectJoint(both, 3))).toEqual([]);
  expect(touched(placeJoint(both, { x: 1, y: 1 }))).toEqual(["cam1"]);
  const dragged = dragJoint(both, { joint: 0, to: { x: 1, y: 1 } });
  expect(touched(dragged)).toEqual(["cam1"]);
  expect(touched(cancelDrag(dragged), dragged)).toEqual([]);
  expect(touched(propagateTo(both, { key: "0|right|cam1", last: 4 })), "made in this picture, for others").toEqual(["cam1"]);
  const suggestions = { byPlace: {}, hidden: new Set<never>() };
  expect(acceptAll(both, { suggestions, cameras: ["cam0"] })).toBe(both);
  expect(touched({ ...both, poses: { ...both.poses, "0|left|cam0": emptyPose() } })).toEqual(["cam0", "cam1"]);
});

test("Q and O toggle; an open joint can be put outside without a click", () => {
  const state = selectJoint(placed(1), 0);
  expect(statusOf(activePose(toggleOccluded(state))[0])).toBe("occluded");
  expect(activePose(toggleOccluded(toggleOccluded(state)))).toEqual(activePose(state));
  expect(statusOf(activePose(toggleOutside(selectJoint(state, 4)))[4])).toBe("outside");
});

test("clearing the only joint removes the annotation", () => {
  expect(clearJoint(selectJoint(placed(1), 0)).poses).toEqual({});
  expect(clearHand(placed(5)).poses).toEqual({});
});

test("B brings the last annotated pose of the same hand, flags and all", () => {
  const before = cycleVisibility(placed(21), 3);
  const later = bringPose(goToFrame(before, 4));
  expect(toWire(activePose(later))).toEqual(toWire(activePose(before)));
  expect(activePose(later)[3]?.from).toEqual({ kind: "copy", label: "frame 0", is_independent: true });
  expect(activePose(nudgeJoint(selectJoint(later, 3), { x: 1, y: 0 }))[3]?.from, "moved by hand").toBeUndefined();
  expect(bringPose(switchHand(goToFrame(before, 4))).poses).toBe(before.poses);
});

test("number keys walk along a finger", () => {
  const once = selectFinger(start, 1);
  expect([once.joint, selectFinger(once, 1).joint, selectFinger(once, -1).joint]).toEqual([5, 6, 0]);
  expect(stepJoint(start, -1).joint).toBe(20);
});

test("frames stop at both ends", () => {
  expect(goToFrame(start, -3).frame).toBe(0);
  expect(goToFrame(start, 99).frame).toBe(9);
});

test("nudging moves by half pixels and leaves open joints alone", () => {
  const state = selectJoint(placed(1), 0);
  expect(activePose(nudgeJoint(state, { x: 0.5, y: 0 }))[0]?.x).toBe(10.5);
  expect(nudgeJoint(selectJoint(state, 9), { x: 1, y: 0 }).poses).toBe(state.poses);
});

test("undo takes back one gesture, goes to its frame, and redo brings it back", () => {
  const store = createStore(start);
  const undo = createUndoStack(store);
  store.set(placeJoint(store.get(), { x: 1, y: 1 }), "person");
  store.set(dragJoint(store.get(), { joint: 0, to: { x: 5, y: 5 } }), "person");
  store.set(dragJoint(store.get(), { joint: 0, to: { x: 6, y: 6 } }), "person");
  store.set(endDrag(store.get(), undefined), "person");
  store.set(goToFrame(store.get(), 5), "person");
  undo.undo();
  expect(store.get().frame).toBe(0);
  expect(activePose(store.get())[0]).toEqual({ x: 1, y: 1, v: 2 });
  undo.undo();
  expect(store.get().poses).toEqual({});
  expect([undo.canUndo(), undo.canRedo(), store.get().joint]).toEqual([false, true, 0]);
  undo.redo();
  undo.redo();
  expect(activePose(store.get())[0]).toEqual({ x: 6, y: 6, v: 2 });
});

test("undo never brings back what somebody else has replaced", () => {
  const store = createStore(start);
  const undo = createUndoStack(store);
  store.set(placed(1), "person");
  store.set({ ...store.get(), poses: { "0|right|cam0": activePose(placed(3)) } }, "server");
  expect(undo.canUndo()).toBe(false);
});

test("a hand can be marked without a mouse", () => {
  const wrist = placeBeside(start, { x: 320, y: 240 });
  expect(activePose(wrist)[0]).toEqual({ x: 320, y: 240, v: 2 });
  const thumb = placeBeside(stepJoint(wrist, 1), { x: 0, y: 0 });
  expect(activePose(thumb)[1]).toEqual({ x: 328, y: 232, v: 2 });
  expect(placeBeside(thumb, { x: 5, y: 5 })).toBe(thumb);
});
