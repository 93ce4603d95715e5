/** Undo and redo: watches the store and keeps changes; nobody else knows that it exists. */

import { parseKey, samePose, type Pose } from "../model/pose";
import { changedKeys, type AnnotatorState } from "./annotator";
import type { Store } from "./store";

interface Change {
  readonly key: string;
  readonly before: Pose | undefined;
  readonly after: Pose | undefined;
  /** The active joint before and after, so that undoing a click makes the same joint next again. */
  readonly jointBefore: number;
  readonly jointAfter: number;
}

const LIMIT = 500;

export interface UndoStack {
  canUndo(): boolean;
  canRedo(): boolean;
  undo(): void;
  redo(): void;
  stop(): void;
}

export function createUndoStack(store: Store<AnnotatorState>): UndoStack {
  let done: Change[][] = [];
  let undone: Change[][] = [];

  const stop = store.watch((now, before, origin) => {
    const keys = changedKeys(now.poses, before.poses);
    if (keys.length === 0) return;
    if (origin === "server") {
      // What somebody else changed must not come back by our undo.
      const isStale = (step: Change[]): boolean => step.some((change) => keys.includes(change.key));
      done = done.filter((step) => !isStale(step));
      undone = undone.filter((step) => !isStale(step));
    } else if (origin === "person") {
      const step = keys.map((key) => ({
        key,
        before: before.poses[key],
        after: now.poses[key],
        jointBefore: before.joint,
        jointAfter: now.joint,
      }));
      if (step.every((change) => samePose(change.before, change.after))) return;
      done = [...done.slice(1 - LIMIT), step];
      undone = [];
    }
  });

  const show = (step: Change[], pick: (change: Change) => Pose | undefined, joint: (change: Change) => number): void => {
    const first = step[0];
    if (!first) return;
    const state = store.get();
    const poses = { ...state.poses };
    for (const change of step) {
      const pose = pick(change);
      if (pose) poses[change.key] = pose;
      else delete poses[change.key];
    }
    const { camera, frame, hand } = parseKey(first.key);
    store.set({ ...state, poses, camera, frame, hand, joint: joint(first), draft: null }, "history");
  };

  return {
    canUndo: () => done.length > 0,
    canRedo: () => undone.length > 0,
    undo() {
      const step = done.at(-1);
      if (!step) return;
      done = done.slice(0, -1);
      undone = [...undone, step];
      show(step, (change) => change.before, (change) => change.jointBefore);
    },
    redo() {
      const step = undone.at(-1);
      if (!step) return;
      undone = undone.slice(0, -1);
      done = [...done, step];
      show(step, (change) => change.after, (change) => change.jointAfter);
    },
    stop,
  };
}
