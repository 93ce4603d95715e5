/** An open recording in the annotator: its store, with undo and saving watching it. */

import type { PersonHere } from "../api/live";
import type { Annotation, Recording, Side } from "../api/types";
import { firstOpenJoint, fromWire, kept, keyText, toKept, type Pose } from "../model/pose";
import { changedKeys, type AnnotatorState } from "./annotator";
import { startInterpolation } from "./interpolation";
import type { KeyFrameStore } from "./keyFrames";
import { joinStatus, type SaveQueue, type SaveStatus } from "./saveQueue";
import { createStore, type Store } from "./store";
import { createSuggestionStore, type SuggestionStore } from "./suggestions";
import { createUndoStack, type UndoStack } from "./undo";

export interface Session {
  readonly store: Store<AnnotatorState>;
  readonly undo: UndoStack;
  readonly queue: SaveQueue;
  /** What machines propose: never saved, until a person accepts it. */
  readonly suggestions: SuggestionStore;
  readonly keyFrames: KeyFrameStore;
  /** Who else has the recording open. */
  readonly people: Store<readonly PersonHere[]>;
  /** Of everything that the person does here: hands, key frames, and what they have in hand. */
  saving: () => SaveStatus;
  watchSaving: (watcher: () => void) => () => void;
  /** Try to send everything now. */
  flush: () => void;
  close: () => void;
}

/** Where the person starts: the address, or the beginning. */
export interface Start {
  camera: string | null;
  frame: number;
  hand: Side;
}

export const revisionsOf = (annotations: readonly Annotation[]): Map<string, number> =>
  new Map(annotations.map((item) => [keyText(item), item.revision]));

/** Annotations as loaded, with what still waits in the queue on top. */
export function openSession(recording: Recording, annotations: readonly Annotation[], queue: SaveQueue, start: Start, keyFrames: KeyFrameStore): Session {
  const poses: Record<string, Pose> = {};
  for (const item of annotations) poses[keyText(item)] = fromWire(kept(item.points, item.sources));
  for (const [key, points] of queue.waiting()) {
    if (points) poses[key] = fromWire(points);
    else delete poses[key];
  }
  const cameras = recording.cameras.map((camera) => camera.id);
  const camera = start.camera !== null && cameras.includes(start.camera) ? start.camera : (cameras[0] ?? "");
  const frame = Math.min(recording.frame_count - 1, Math.max(0, start.frame));
  const store = createStore<AnnotatorState>({
    poses,
    camera,
    frame,
    frameCount: recording.frame_count,
    frames: null,
    hand: start.hand,
    joint: firstOpenJoint(poses[keyText({ camera, frame, hand: start.hand })]),
    isChosen: false,
    draft: null,
  });
  const undo = createUndoStack(store);
  const suggestions = createSuggestionStore();
  const stopInterpolation = startInterpolation(store, keyFrames.store, suggestions, cameras);
  const stopSaving = store.watch((now, before, origin) => {
    if (origin === "server") return;
    for (const key of changedKeys(now.poses, before.poses)) {
      const pose = now.poses[key];
      queue.put(key, pose ? toKept(pose) : null);
    }
  });
  const describe = (): SaveStatus => joinStatus(queue.status(), keyFrames.queue.status(), store.get().draft !== null);
  let saving = describe();
  const watchers = new Set<() => void>();
  const tell = (): void => {
    saving = describe();
    watchers.forEach((watcher) => watcher());
  };
  const stops = [queue.watch(tell), keyFrames.queue.watch(tell), store.watch((now, before) => (now.draft !== null) !== (before.draft !== null) && tell())];
  return {
    store,
    undo,
    queue,
    suggestions,
    keyFrames,
    people: createStore<readonly PersonHere[]>([]),
    saving: () => saving,
    watchSaving(watcher) {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
    flush() {
      queue.flush();
      keyFrames.queue.flush();
    },
    close() {
      stops.forEach((stop) => stop());
      keyFrames.close();
      stopInterpolation();
      stopSaving();
      undo.stop();
    },
  };
}

/** Settle a conflict: what was chosen is stored here too. */
export function settleConflict(session: Session, key: string, choice: "mine" | "theirs" | Pose): void {
  const theirs = session.queue.status().conflicts.get(key);
  if (!theirs) return;
  const state = session.store.get();
  if (choice === "mine") {
    const mine = state.poses[key];
    session.queue.settle(key, mine ? toKept(mine) : null);
    return;
  }
  const pose = choice === "theirs" ? (theirs.points ? fromWire(theirs.points) : undefined) : choice;
  const { [key]: replaced, ...others } = state.poses;
  void replaced;
  session.store.set({ ...state, draft: null, poses: pose ? { ...others, [key]: pose } : others }, "server");
  session.queue.settle(key, choice === "theirs" ? "theirs" : toKept(choice));
}
