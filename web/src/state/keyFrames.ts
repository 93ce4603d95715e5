/** Key frames: between two of them the machine proposes. Everybody who marks the recording has the same ones. */

import type { SaveQueue } from "./saveQueue";
import { createStore, type Store } from "./store";

/** Texts of `keyText`. */
export type KeyFrames = ReadonlySet<string>;

export interface KeyFrameStore {
  readonly store: Store<KeyFrames>;
  readonly queue: SaveQueue;
  /** Make it one, or none any more; taken back here when the server does not take it. */
  toggle: (key: string) => void;
  /** All that the server has now; what still waits here stays. */
  learn: (found: Iterable<string>) => void;
  close: () => void;
}

/** A key frame has no points of its own: these say that it is one, null that it is none any more. */
const IS_KEY: never[] = [];

export function createKeyFrames(found: Iterable<string>, queue: SaveQueue, onRefusal: (reason: string) => void): KeyFrameStore {
  let known = new Set(found);
  const withWaiting = (): KeyFrames => {
    const now = new Set(known);
    for (const [key, points] of queue.waiting()) {
      if (points) now.add(key);
      else now.delete(key);
    }
    return now;
  };
  const store = createStore<KeyFrames>(withWaiting());
  const show = (): void => {
    const [now, next] = [store.get(), withWaiting()];
    if (now.size !== next.size || [...next].some((key) => !now.has(key))) store.set(next, "server");
  };
  const stop = queue.watch(() => {
    for (const [key, reason] of queue.status().refusals) {
      if (queue.waiting().get(key)) known.delete(key);
      else known.add(key);
      queue.discard(key);
      onRefusal(reason);
      show();
    }
  });
  return {
    store,
    queue,
    toggle(key) {
      const isKey = !store.get().has(key);
      queue.put(key, isKey ? IS_KEY : null);
      // By the time that it does not wait any more, the server has it.
      if (isKey) known.add(key);
      else known.delete(key);
      show();
    },
    learn(items) {
      known = new Set(items);
      show();
    },
    close: stop,
  };
}
