/** Key frames: between two of them the machine proposes. Everybody who marks the recording has the same ones. */

import { createStore, type Store } from "./store";

/** Texts of `keyText`. */
export type KeyFrames = ReadonlySet<string>;

export interface KeyFrameStore {
  readonly store: Store<KeyFrames>;
  /** Make it one, or none any more; taken back here when the server does not take it. */
  toggle(key: string): void;
}

export function createKeyFrames(found: Iterable<string>, send: (key: string, isKey: boolean) => Promise<void>, onFailure: (reason: Error) => void): KeyFrameStore {
  const store = createStore<KeyFrames>(new Set(found));
  const put = (key: string, isKey: boolean): void => {
    const next = new Set(store.get());
    if (isKey) next.add(key);
    else next.delete(key);
    store.set(next, "person");
  };
  return {
    store,
    toggle(key) {
      const isKey = !store.get().has(key);
      put(key, isKey);
      send(key, isKey).catch((reason: Error) => {
        put(key, !isKey);
        onFailure(reason);
      });
    },
  };
}
