/** The save queues of this browser's person, one for each recording and blind replica; they outlive the pages and a reload. */

import { sendAnnotation, sendKeyFrame } from "../api/annotations";
import { flushDecisions } from "./deciding";
import { createJournal, findWaiting } from "./journal";
import { accountId } from "./me";
import { createSaveQueue, type SaveQueue } from "./saveQueue";

const queues = new Map<string, SaveQueue>();
const watchers = new Set<() => void>();

/** Every queue there is, by scope. */
export const allQueues = (): ReadonlyMap<string, SaveQueue> => queues;

/** Hear of every change of every queue, also of those that are made later; returns the way to stop. */
export function watchQueues(watcher: () => void): () => void {
  watchers.add(watcher);
  return () => watchers.delete(watcher);
}

/** What a queue saves to: a recording's id, and behind "~" the blind replica's where there is one. */
export const scopeOf = (recording: string, replica?: string | null): string => (replica ? `${recording}~${replica}` : recording);

/** Key frames have a queue of their own, behind "+" in a scope's name: a hand and its key frame are two things to save. */
const KEYS = "+keys";

export const keyQueueOf = (scope: string): SaveQueue => queueOf(scope + KEYS);

export function queueOf(scope: string): SaveQueue {
  let queue = queues.get(scope);
  if (!queue) {
    const [place = "", keys] = scope.split("+");
    const [recording = "", replica] = place.split("~");
    const journal = createJournal(window.localStorage, accountId(), scope);
    queue = createSaveQueue((key, save) => (keys === undefined ? sendAnnotation : sendKeyFrame)(recording, key, save, replica), journal);
    queue.watch(() => watchers.forEach((watcher) => watcher()));
    queues.set(scope, queue);
  }
  return queue;
}

/** Try to send everything that waits, now. */
export function flushSaving(): void {
  queues.forEach((queue) => queue.flush());
  flushDecisions();
}

/** Send what an earlier visit of this person could not; called once, when it is known who it is. */
export function resumeSaving(): void {
  findWaiting(window.localStorage, accountId()).forEach((scope) => queueOf(scope).flush());
  flushDecisions();
  window.addEventListener("online", flushSaving);
}
