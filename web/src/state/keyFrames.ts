/** Key frames by hand: between two of them the machine proposes. Working notes of this person, kept in the browser. */

import { createStore, type Store } from "./store";

/** Texts of `keyText`. */
export type KeyFrames = ReadonlySet<string>;

export function createKeyFrames(recording: string): Store<KeyFrames> {
  const name = `handloom/key-frames/${recording}`;
  const read = (): KeyFrames => {
    try {
      const found: unknown = JSON.parse(window.localStorage.getItem(name) ?? "[]");
      return new Set(Array.isArray(found) ? found.filter((key): key is string => typeof key === "string") : []);
    } catch {
      return new Set();
    }
  };
  const store = createStore<KeyFrames>(read());
  store.watch((now) => {
    try {
      if (now.size === 0) window.localStorage.removeItem(name);
      else window.localStorage.setItem(name, JSON.stringify([...now]));
    } catch {
      // Without storage they last as long as the page.
    }
  });
  return store;
}

export function toggleKey(store: Store<KeyFrames>, key: string): void {
  const next = new Set(store.get());
  if (!next.delete(key)) next.add(key);
  store.set(next, "person");
}
