/** A component hears of the part of a store that it shows, and of nothing else. */

import { useMemo, useSyncExternalStore } from "react";

interface Readable<S> {
  get: () => S;
  watch: (watcher: () => void) => () => void;
}

const whole = <S>(state: S): S => state;

/** What `select` makes of the store's value; the component is drawn again when that is another value by `isSame`. */
export function useSelect<S, T>(store: Readable<S>, select: (state: S) => T, isSame: (a: T, b: T) => boolean = Object.is): T {
  const read = useMemo(() => {
    let last: { state: S; value: T } | null = null;
    return (): T => {
      const state = store.get();
      if (last?.state === state) return last.value;
      const value = select(state);
      last = { state, value: last && isSame(last.value, value) ? last.value : value };
      return last.value;
    };
  }, [store, select, isSame]);
  return useSyncExternalStore(store.watch, read);
}

/** The whole value of a store. */
export const useStore = <S>(store: Readable<S>): S => useSelect(store, whole);

/** Two lists with the same members. */
export const sameList = <T>(a: readonly T[], b: readonly T[]): boolean => a === b || (a.length === b.length && a.every((one, index) => Object.is(one, b[index])));
