import { expect, test } from "vitest";
import { keyFramesOf, spanAt } from "../../model/interpolation";
import { emptyPose, keyText, type Pose } from "../../model/pose";
import { activePose, type AnnotatorState } from "../../state/annotator";
import { startInterpolation } from "../../state/interpolation";
import type { KeyFrames } from "../../state/keyFrames";
import { createStore } from "../../state/store";
import { createSuggestionStore, openJointsAt } from "../../state/suggestions";
import { createUndoStack } from "../../state/undo";
import { acceptBetween } from "./acceptBetween";
import { endDrag } from "./move";
import { placeIn } from "./place";
import { copyOf } from "./bring";
import { openFramesAhead, propagateOn, propagateTo } from "./propagate";
import { swapHands } from "./swap";
import { turnHand } from "./turn";

const pose = (x: number, y = 0): Pose => Array.from({ length: 21 }, (_, joint) => ({ x: x + joint, y: y + 2 * joint, v: 2 as const }));
const start = (poses: AnnotatorState["poses"], frame = 0): AnnotatorState => ({ poses, camera: "cam0", frame, frameCount: 20, frames: null, hand: "right", joint: 0, isChosen: false, draft: null });
const key = (frame: number, hand: "right" | "left" = "right"): string => keyText({ camera: "cam0", frame, hand });

test("a quarter turn about a joint leaves it and carries the others round; outside joints without a place stay out", () => {
  const from = pose(10).with(5, { x: -1, y: -1, v: 0 });
  const turned = activePose(endDrag(turnHand(start({ [key(0)]: from }), { about: { x: 10, y: 0 }, angle: Math.PI / 2, factor: 2 })));
  expect(turned[0]).toEqual({ x: 10, y: 0, v: 2 });
  expect([turned[1]?.x, turned[1]?.y]).toEqual([expect.closeTo(10 - 4), expect.closeTo(2)]);
  expect(turned[5]).toEqual(from[5]);
});

test("swapping exchanges both hands in one step, and twice is as before", () => {
  const store = createStore(start({ [key(0)]: pose(1), [key(0, "left")]: pose(50) }));
  const undo = createUndoStack(store);
  store.set(swapHands(store.get()), "person");
  expect([store.get().poses[key(0)]?.[0]?.x, store.get().poses[key(0, "left")]?.[0]?.x]).toEqual([50, 1]);
  undo.undo();
  expect(store.get().poses[key(0)]?.[0]?.x).toBe(1);
  expect(undo.canUndo()).toBe(false);
  const alone = swapHands(start({ [key(0)]: pose(1) }));
  expect(Object.keys(alone.poses)).toEqual([key(0, "left")]);
});

test("a pose is carried up to the next annotated frame and never over it", () => {
  const state = start({ [key(3)]: pose(1), [key(7)]: pose(2) }, 3);
  expect(openFramesAhead(state)).toEqual([4, 5, 6]);
  const all = propagateTo(state, { key: key(3), last: 19 });
  expect(Object.keys(all.poses).length).toBe(5);
  expect(all.poses[key(7)]).toBe(state.poses[key(7)]);
  expect(propagateTo({ ...state, frame: 4 }, { key: key(3), last: 19 }).poses, "asked for at a frame that is not in view any more").toBe(state.poses);
  const once = propagateOn(state);
  expect([once.frame, once.poses[key(4)]]).toEqual([4, copyOf(pose(1), 3)]);
  expect(propagateOn({ ...state, frame: 6 }).poses).toBe(state.poses);
});

test("undoing what was done over many frames goes back to where it was asked for", () => {
  const store = createStore(start({ [key(3)]: pose(1) }, 3));
  const undo = createUndoStack(store);
  store.set(propagateTo(store.get(), { key: key(3), last: 9 }), "person");
  store.set({ ...store.get(), frame: 8 }, "person");
  undo.undo();
  expect([store.get().frame, Object.keys(store.get().poses)]).toEqual([3, [key(3)]]);
});

test("a click goes on to the next joint, to the next frame, or stays", () => {
  const state = start({});
  const at = { x: 5, y: 5 };
  expect([placeIn.joint(state, at).joint, placeIn.joint(state, at).frame]).toEqual([1, 0]);
  expect([placeIn.frame(state, at).joint, placeIn.frame(state, at).frame]).toEqual([0, 1]);
  expect([placeIn.stay(state, at).joint, placeIn.stay(state, at).frame]).toEqual([0, 0]);
});

test("key frames pair up around a frame, and only where there is an annotation", () => {
  const poses = { [key(2)]: pose(0), [key(6)]: pose(4), [key(9)]: pose(5) };
  const frames = keyFramesOf(new Set([key(9), key(2), key(6), key(12), key(6, "left")]), poses, { camera: "cam0", hand: "right" });
  expect(frames).toEqual([2, 6, 9]);
  expect([0, 2, 4, 6, 9, 12].map((frame) => spanAt(frames, frame))).toEqual([null, [2, 6], [2, 6], [6, 9], [6, 9], null]);
});

test("between key frames positions are proposed, follow their ends, and accepting them is one step", () => {
  const annotator = createStore(start({ [key(2)]: pose(0), [key(6)]: pose(8).with(3, { x: 11, y: 6, v: 1 }) }, 4));
  const keys = createStore<KeyFrames>(new Set([key(2)]));
  const suggestions = createSuggestionStore();
  const undo = createUndoStack(annotator);
  startInterpolation(annotator, keys, suggestions, ["cam0"]);
  const here = (frame: number) => openJointsAt(suggestions.get(), annotator.get(), { camera: "cam0", frame, hand: "right" });
  expect(here(4)[0]).toBeNull();
  keys.set(new Set([key(2), key(6)]), "person");
  expect(here(3)[0]?.px).toEqual([2, 0]);
  expect(here(5)[3]?.guess).toBe("occluded");
  annotator.set({ ...annotator.get(), poses: { ...annotator.get().poses, [key(6)]: pose(16), [key(4)]: emptyPose().with(0, { x: 99, y: 99, v: 2 }) } }, "person");
  expect(here(3)[0]?.px).toEqual([4, 0]);
  annotator.set(acceptBetween(annotator.get(), [2, 6]), "person");
  expect([3, 4, 5].map((frame) => annotator.get().poses[key(frame)]?.[0]?.x)).toEqual([4, 99, 12]);
  expect(annotator.get().poses[key(4)]?.[1]).toEqual({ x: 9, y: 2, v: 2, from: { kind: "interpolation", label: "key frames 2 and 6", is_independent: true } });
  expect(here(4).every((joint) => joint === null)).toBe(true);
  undo.undo();
  expect(Object.keys(annotator.get().poses).sort()).toEqual([key(2), key(4), key(6)].sort());
});
