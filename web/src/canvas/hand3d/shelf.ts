/** Hands that are shown soon, loaded and brought to the graphics card before anybody asks for them. */

import { isForGood, onNetworkBack, pauseAfter } from "../patience";
import type { HandGeometry } from "./geometry";
import type { Stage } from "./stage";
import type { Staged } from "./staged";

export interface Shelf {
  /** What is wanted, the most urgent first; everything else may be put away. */
  want: (ids: readonly string[]) => void;
  /** A hand that can be drawn at once; null while it is on its way. What failed for a passing reason is asked for again by itself. */
  get: (id: string) => Staged | null;
  failureOf: (id: string) => Error | null;
  /** Ask again for what failed. */
  retry: (id: string) => void;
  /** Tells which one has come, or failed. */
  watch: (watcher: (id: string) => void) => () => void;
  stop: () => void;
}

type Load = (id: string, signal: AbortSignal) => Promise<HandGeometry>;

/** So many at a time: the first one wanted is never starved by those behind it. */
const AT_ONCE = 2;

interface Slot {
  readonly abort: AbortController;
  hand: Staged | null;
  failure: Error | null;
  /** How often it failed, and until when it is left alone. */
  failures: number;
  pause: ReturnType<typeof setTimeout> | null;
}

/** `later` says when there is time to bring a hand to the card that nobody waits for. */
export function createShelf(
  stage: Pick<Stage, "prepare">,
  load: Load,
  later: (act: () => void) => void = (act) => (typeof requestIdleCallback === "undefined" ? setTimeout(act, 0) : requestIdleCallback(act, { timeout: 400 })),
): Shelf {
  const slots = new Map<string, Slot>();
  const watchers = new Set<(id: string) => void>();
  let wanted: readonly string[] = [];
  let busy = 0;
  let isStopped = false;

  const tell = (id: string): void => watchers.forEach((watcher) => watcher(id));

  function fill(): void {
    for (const id of wanted) {
      if (busy >= AT_ONCE || isStopped) return;
      if (!slots.has(id)) void fetchOne(id);
      // What is shown next does not come: nothing behind it is tried.
      if (slots.get(id)?.failure && slots.get(id)?.pause) return;
    }
  }

  function resume(id: string, slot: Slot): void {
    if (slot.pause === null || slots.get(id) !== slot || isStopped) return;
    clearTimeout(slot.pause);
    slot.pause = null;
    void fetchOne(id, slot);
  }

  async function fetchOne(id: string, slot: Slot = { abort: new AbortController(), hand: null, failure: null, failures: 0, pause: null }): Promise<void> {
    slots.set(id, slot);
    busy += 1;
    try {
      const geometry = await load(id, slot.abort.signal);
      if (id !== wanted[0]) await new Promise<void>((resolve) => later(resolve));
      if (isStopped || slots.get(id) !== slot) return;
      slot.hand = stage.prepare(geometry);
      slot.failure = null;
    } catch (failure) {
      if (slots.get(id) !== slot) return;
      slot.failure = failure instanceof Error ? failure : new Error(String(failure));
      slot.failures += 1;
      if (!isForGood(slot.failure)) slot.pause = setTimeout(() => resume(id, slot), pauseAfter(slot.failures));
    } finally {
      busy -= 1;
      fill();
    }
    tell(id);
  }

  function putAway(id: string): void {
    const slot = slots.get(id);
    slots.delete(id);
    if (slot?.pause) clearTimeout(slot.pause);
    if (!slot?.hand) slot?.abort.abort();
    slot?.hand?.release();
  }

  const stopListening = onNetworkBack(() => slots.forEach((slot, id) => resume(id, slot)));

  return {
    want(ids) {
      wanted = [...new Set(ids)];
      for (const id of [...slots.keys()]) if (!wanted.includes(id)) putAway(id);
      fill();
    },
    get: (id) => slots.get(id)?.hand ?? null,
    failureOf: (id) => slots.get(id)?.failure ?? null,
    retry(id) {
      putAway(id);
      fill();
    },
    watch(watcher) {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
    stop() {
      isStopped = true;
      stopListening();
      [...slots.keys()].forEach(putAway);
    },
  };
}
