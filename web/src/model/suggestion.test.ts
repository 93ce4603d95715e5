import { expect, test } from "vitest";
import { acceptAll, acceptHand, acceptJoint } from "../actions/annotate/accept";
import type { AnnotatorState } from "../state/annotator";
import { createStore } from "../state/store";
import { createSuggestionStore, openJointsAt, setHidden, suggest, withdraw } from "../state/suggestions";
import { createUndoStack } from "../state/undo";
import { emptyPose, keyText, withJoint, type PoseKey } from "./pose";
import { openJoints, type Source, type SuggestedJoint, type Suggestion } from "./suggestion";

const place: PoseKey = { camera: "cam0", frame: 3, hand: "right" };
const suggestion = (source: Source, x: number, joints = 21, at = place): Suggestion => ({
  source,
  label: source,
  place: at,
  joints: Array.from({ length: 21 }, (_, joint): SuggestedJoint | null => (joint < joints ? { px: [x, joint], guess: joint === 1 ? "occluded" : "visible" } : null)),
});
const start = (poses: AnnotatorState["poses"] = {}): AnnotatorState => ({ poses, camera: "cam0", frame: 3, frameCount: 9, frames: null, hand: "right", joint: 0, isChosen: false, draft: null });

test("each joint is suggested by the first source that has it, hidden ones left out", () => {
  const seen = { detector: suggestion("detector", 5), track: suggestion("track", 10, 3) };
  expect(openJoints(seen, undefined, new Set()).map((joint) => joint?.from.kind)).toEqual([...Array<string>(3).fill("track"), ...Array<string>(18).fill("detector")]);
  const both = { track: suggestion("track", 10), interpolation: suggestion("interpolation", 20, 5) };
  const open = openJoints(both, undefined, new Set());
  expect(open.map((joint) => joint?.px[0])).toEqual([...Array<number>(5).fill(20), ...Array<number>(16).fill(10)]);
  expect(openJoints(both, undefined, new Set<Source>(["interpolation"])).every((joint) => joint?.source === "track")).toBe(true);
});

test("what somebody placed, or said is outside, is neither suggested again nor moved by accepting", () => {
  const mine = withJoint(withJoint(emptyPose(), 0, { x: 1, y: 2, v: 2 }), 4, { x: -1, y: -1, v: 0 });
  const store = createSuggestionStore();
  suggest(store, [suggestion("track", 50)]);
  const state = start({ [keyText(place)]: mine });
  expect(openJointsAt(store.get(), state, place).flatMap((joint, index) => (joint ? [] : [index]))).toEqual([0, 4]);
  const accepted = acceptHand(state, store.get()).poses[keyText(place)];
  expect(accepted?.[0]).toEqual({ x: 1, y: 2, v: 2 });
  expect(accepted?.[4]).toEqual({ x: -1, y: -1, v: 0 });
  expect(accepted?.[1]).toEqual({ x: 50, y: 1, v: 1, from: { kind: "track", label: "track" } });
  expect(accepted?.[20]).toEqual({ x: 50, y: 20, v: 2, from: { kind: "track", label: "track" } });
});

test("one joint at a time is accepted and the next open one follows", () => {
  const store = createSuggestionStore();
  suggest(store, [suggestion("fit", 7, 2)]);
  const once = acceptJoint(start(), store.get());
  expect([once.joint, once.poses[keyText(place)]?.[0]]).toEqual([1, { x: 7, y: 0, v: 2, from: { kind: "fit", label: "fit" } }]);
  const twice = acceptJoint(once, store.get());
  expect(acceptJoint(twice, store.get())).toBe(twice);
});

test("accepting the frame takes both hands in one step of undo", () => {
  const store = createSuggestionStore();
  suggest(store, [suggestion("track", 5), suggestion("track", 6, 21, { ...place, hand: "left" }), suggestion("track", 9, 21, { ...place, frame: 4 })]);
  const annotator = createStore(start());
  const undo = createUndoStack(annotator);
  annotator.set(acceptAll(annotator.get(), { suggestions: store.get(), cameras: ["cam0"] }), "person");
  expect(Object.keys(annotator.get().poses).sort()).toEqual(["3|left|cam0", "3|right|cam0"]);
  undo.undo();
  expect(annotator.get().poses).toEqual({});
  expect(undo.canUndo()).toBe(false);
});

test("suggestions are withdrawn by source and by hand, and hidden without being lost", () => {
  const store = createSuggestionStore();
  suggest(store, [suggestion("track", 5), suggestion("fit", 6)]);
  withdraw(store, "fit", { ...place, frame: 1 });
  expect(openJointsAt(store.get(), start(), place)[0]?.source).toBe("fit");
  setHidden(store, ["fit"]);
  expect(openJointsAt(store.get(), start(), place)[0]?.source).toBe("track");
  withdraw(store, "track");
  expect(acceptAll(start(), { suggestions: store.get(), cameras: ["cam0"] }).poses).toEqual({});
});
