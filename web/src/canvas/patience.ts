/** When to ask again for what did not come: later and later, and never for what the server will not give. */

import { ApiError } from "../api/client";

const FIRST_MS = 1000;
const LONGEST_MS = 10_000;

/** Answers that may be another one in a moment: too slow, too many. */
const PASSING = [408, 429];

/** Whether asking again would bring the same: the server has no such thing, or what it sent cannot be read. */
export function isForGood(failure: Error): boolean {
  // A connection that broke in the middle of an answer.
  if (failure instanceof TypeError) return false;
  return !(failure instanceof ApiError && (failure.status === 0 || failure.status >= 500 || PASSING.includes(failure.status)));
}

/** After so many failures in a row: 1, 2, 4, 8, 10, 10, ... seconds. */
export const pauseAfter = (failures: number): number => Math.min(LONGEST_MS, FIRST_MS * 2 ** (failures - 1));

/** Tells when this computer has its network back; returns the way to stop. */
export function onNetworkBack(tell: () => void): () => void {
  // Units run without a window.
  globalThis.addEventListener?.("online", tell);
  return () => globalThis.removeEventListener?.("online", tell);
}
