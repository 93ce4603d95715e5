/** The save queues of this browser's person, one for each recording; they outlive the pages and a reload. */

import { sendAnnotation } from "../api/annotations";
import { createJournal, findWaiting } from "./journal";
import { accountId } from "./me";
import { createSaveQueue, type SaveQueue } from "./saveQueue";

const queues = new Map<string, SaveQueue>();

export function queueOf(recording: string): SaveQueue {
  let queue = queues.get(recording);
  if (!queue) {
    const journal = createJournal(window.localStorage, accountId(), recording);
    queue = createSaveQueue((key, save) => sendAnnotation(recording, key, save), journal);
    queues.set(recording, queue);
  }
  return queue;
}

/** Try to send everything that waits, now. */
export const flushSaving = (): void => queues.forEach((queue) => queue.flush());

/** Send what an earlier visit of this person could not; called once, when it is known who it is. */
export function resumeSaving(): void {
  findWaiting(window.localStorage, accountId()).forEach((recording) => queueOf(recording).flush());
  window.addEventListener("online", flushSaving);
}
