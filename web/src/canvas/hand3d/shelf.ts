/** Hands that are shown soon, loaded and brought to the graphics card before anybody asks for them. */

import type { HandGeometry } from "./geometry";
import type { Stage } from "./stage";
import type { Staged } from "./staged";

export interface Shelf {
  /** What is wanted, the most urgent first; everything else may be put away. */
  want(ids: readonly string[]): void;
  /** A hand that can be drawn at once; null while it is on its way. */
  get(id: string): Staged | null;
  failureOf(id: string): Error | null;
  /** Ask again for what failed. */
  retry(id: string): void;
  /** Tells which one has come, or failed. */
  watch(watcher: (id: string) => void): () => void;
  stop(): void;
}

type Load = (id: string, signal: AbortSignal) => Promise<HandGeometry>;

/** So many at a time: the first one wanted is never starved by those behind it. */
const AT_ONCE = 2;

interface Slot {
  readonly abort: AbortController;
  hand: Staged | null;
  failure: Error | null;
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
    }
  }

  async function fetchOne(id: string): Promise<void> {
    const slot: Slot = { abort: new AbortController(), hand: null, failure: null };
    slots.set(id, slot);
    busy += 1;
    try {
      const geometry = await load(id, slot.abort.signal);
      if (id !== wanted[0]) await new Promise<void>((resolve) => later(resolve));
      if (isStopped || slots.get(id) !== slot) return;
      slot.hand = stage.prepare(geometry);
    } catch (failure) {
      if (slots.get(id) !== slot) return;
      slot.failure = failure instanceof Error ? failure : new Error(String(failure));
    } finally {
      busy -= 1;
      fill();
    }
    tell(id);
  }

  function putAway(id: string): void {
    const slot = slots.get(id);
    slots.delete(id);
    if (!slot?.hand) slot?.abort.abort();
    slot?.hand?.release();
  }

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
      [...slots.keys()].forEach(putAway);
    },
  };
}
