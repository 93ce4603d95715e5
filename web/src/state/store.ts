/** A value that changes by whole replacement, and those who watch it. */

/** Who changed the state: undo and saving care only about some of them. */
export type Origin = "person" | "server" | "history";

export type Watcher<S> = (now: S, before: S, origin: Origin) => void;

export interface Store<S> {
  get: () => S;
  set: (next: S, origin: Origin) => void;
  /** Returns the way to stop. */
  watch: (watcher: Watcher<S>) => () => void;
}

export function createStore<S>(initial: S): Store<S> {
  let state = initial;
  const watchers = new Set<Watcher<S>>();
  return {
    get: () => state,
    set(next, origin) {
      if (next === state) return;
      const before = state;
      state = next;
      watchers.forEach((watcher) => watcher(next, before, origin));
    },
    watch(watcher) {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
  };
}
