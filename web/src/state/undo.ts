/** Undo and redo: watches the store and keeps changes; nobody else knows that it exists. */

import { samePose, type Pose } from "../model/pose";
import { changedKeys, type AnnotatorState } from "./annotator";
import type { Store } from "./store";

interface Change {
  readonly key: string;
  readonly before: Pose | undefined;
  readonly after: Pose | undefined;
}

/** Where the person was; undoing goes back there, so that undoing a click makes the same joint next again. */
type Place = Pick<AnnotatorState, "camera" | "frame" | "hand" | "joint">;

interface Step {
  readonly changes: readonly Change[];
  readonly before: Place;
  readonly after: Place;
}

const placeOf = ({ camera, frame, hand, joint }: AnnotatorState): Place => ({ camera, frame, hand, joint });

const LIMIT = 500;

export interface UndoStack {
  canUndo: () => boolean;
  canRedo: () => boolean;
  undo: () => void;
  redo: () => void;
  stop: () => void;
}

export function createUndoStack(store: Store<AnnotatorState>): UndoStack {
  let done: Step[] = [];
  let undone: Step[] = [];

  const stop = store.watch((now, before, origin) => {
    const keys = changedKeys(now.poses, before.poses);
    if (keys.length === 0) return;
    if (origin === "server") {
      // What somebody else changed must not come back by our undo.
      const isStale = (step: Step): boolean => step.changes.some((change) => keys.includes(change.key));
      done = done.filter((step) => !isStale(step));
      undone = undone.filter((step) => !isStale(step));
    } else if (origin === "person") {
      const changes = keys.map((key) => ({ key, before: before.poses[key], after: now.poses[key] }));
      if (changes.every((change) => samePose(change.before, change.after))) return;
      const step = { changes, before: placeOf(before), after: placeOf(now) };
      done = [...done.slice(1 - LIMIT), step];
      undone = [];
    }
  });

  const show = (step: Step, pick: (change: Change) => Pose | undefined, place: Place): void => {
    const state = store.get();
    const poses = { ...state.poses };
    for (const change of step.changes) {
      const pose = pick(change);
      if (pose) poses[change.key] = pose;
      else delete poses[change.key];
    }
    store.set({ ...state, ...place, poses, draft: null, isChosen: false }, "history");
  };

  return {
    canUndo: () => done.length > 0,
    canRedo: () => undone.length > 0,
    undo() {
      const step = done.at(-1);
      if (!step) return;
      done = done.slice(0, -1);
      undone = [...undone, step];
      show(step, (change) => change.before, step.before);
    },
    redo() {
      const step = undone.at(-1);
      if (!step) return;
      undone = undone.slice(0, -1);
      done = [...done, step];
      show(step, (change) => change.after, step.after);
    },
    stop,
  };
}
