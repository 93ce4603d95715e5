/** The save queues of this browser, one for each recording; they outlive the pages and a reload. */

import { sendAnnotation } from "../api/annotations";
import { createJournal } from "./journal";
import { createSaveQueue, type SaveQueue } from "./saveQueue";

const queues = new Map<string, SaveQueue>();

export function queueOf(recording: string): SaveQueue {
  let queue = queues.get(recording);
  if (!queue) {
    queue = createSaveQueue((key, save) => sendAnnotation(recording, key, save), createJournal(window.localStorage, recording));
    queues.set(recording, queue);
  }
  return queue;
}

/** Try to send everything that waits, now. */
export const flushSaving = (): void => queues.forEach((queue) => queue.flush());

/** Send what an earlier visit could not; called once when the app starts. */
export function resumeSaving(): void {
  const recordings = new Set<string>();
  for (let index = 0; index < window.localStorage.length; index += 1) {
    const match = /^handloom\/unsaved\/([^/]+)\//.exec(window.localStorage.key(index) ?? "");
    if (match?.[1]) recordings.add(match[1]);
  }
  recordings.forEach((recording) => queueOf(recording).flush());
  window.addEventListener("online", flushSaving);
}
