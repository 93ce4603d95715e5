/** Something on its way into the studio, kept outside the pages so that walking about does not stop it. */

import { useSyncExternalStore } from "react";
import { ApiError } from "../api/client";
import type { DroppedFile } from "../api/imports";
import { createStore } from "./store";

export interface Upload<R> {
  /** Null until somebody has said to send it; 0..1; 1 means that the server is reading it. */
  readonly sent: number | null;
  readonly failure: Error | null;
  readonly result: R | null;
}

export interface FileUpload<R> extends Upload<R> {
  readonly files: readonly DroppedFile[];
  readonly bytes: number;
}

export const UNSENT: Upload<never> = { sent: null, failure: null, result: null };

export const countBytes = (files: readonly DroppedFile[]): number => files.reduce((sum, { file }) => sum + file.size, 0);

export type Tell<U> = (change: Partial<U>) => void;

/** The one upload of a kind; `none` is what it is before anything was chosen. */
export function createUpload<U extends Upload<unknown>, N extends U | null>(none: N) {
  const store = createStore<U | N>(none);
  let abort: AbortController | null = null;
  const change: Tell<U> = (changes) => {
    const now = store.get();
    if (now) store.set({ ...now, ...changes }, "person");
  };
  const stop = (): void => {
    abort?.abort();
    abort = null;
  };
  return {
    use: (): U | N => useSyncExternalStore((tell) => store.watch(tell), store.get),
    get: store.get,
    choose: (chosen: U): void => store.set(chosen, "person"),
    change,
    /** One request about what was chosen; a newer one, or an end, stops it. */
    work: async (begin: Partial<U>, act: (chosen: U, tell: Tell<U>, signal: AbortSignal) => Promise<Partial<U>>): Promise<void> => {
      const chosen = store.get();
      if (!chosen) return;
      stop();
      const mine = new AbortController();
      abort = mine;
      const tell: Tell<U> = (changes) => {
        if (abort === mine) change(changes);
      };
      tell({ ...begin, failure: null });
      try {
        tell(await act(chosen, tell, mine.signal));
      } catch (failure) {
        const isAbort = failure instanceof DOMException && failure.name === "AbortError";
        const told: Partial<Upload<unknown>> = { sent: null, failure: failure instanceof Error ? failure : new ApiError(0, "Error", String(failure)) };
        if (!isAbort) tell(told as Partial<U>);
      }
    },
    stop,
    /** Forget what was chosen. */
    end: (): void => {
      stop();
      store.set(none, "person");
    },
  };
}
