/** The save queues of this browser's person, one for each recording and blind replica; they outlive the pages and a reload. */

import { sendAnnotation } from "../api/annotations";
import { flushDecisions } from "./deciding";
import { createJournal, findWaiting } from "./journal";
import { accountId } from "./me";
import { createSaveQueue, type SaveQueue } from "./saveQueue";

const queues = new Map<string, SaveQueue>();

/** What a queue saves to: a recording's id, and behind "~" the blind replica's where there is one. */
export const scopeOf = (recording: string, replica?: string | null): string => (replica ? `${recording}~${replica}` : recording);

export function queueOf(scope: string): SaveQueue {
  let queue = queues.get(scope);
  if (!queue) {
    const [recording = "", replica] = scope.split("~");
    const journal = createJournal(window.localStorage, accountId(), scope);
    queue = createSaveQueue((key, save) => sendAnnotation(recording, key, save, replica), journal);
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
