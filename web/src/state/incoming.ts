/** Files on their way into the studio, kept outside the pages so that walking about does not stop an upload. */

import { useSyncExternalStore } from "react";
import { ApiError } from "../api/client";
import { sendFiles, type DroppedFile, type ImportOptions } from "../api/imports";
import type { Import } from "../api/types";
import { createStore } from "./store";

export interface Incoming {
  readonly files: readonly DroppedFile[];
  readonly bytes: number;
  /** 0..1; 1 means that the server is checking. */
  readonly sent: number;
  readonly failure: Error | null;
  readonly result: Import | null;
}

const store = createStore<Incoming | null>(null);
let abort: AbortController | null = null;

export const useIncoming = (): Incoming | null => useSyncExternalStore((tell) => store.watch(tell), store.get);

/** Send files; whatever was being sent before is called off. */
export async function sendIncoming(files: readonly DroppedFile[], options: ImportOptions = {}): Promise<void> {
  abort?.abort();
  const mine = new AbortController();
  abort = mine;
  const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
  const tell = (change: Partial<Incoming>): void => {
    const now = store.get();
    if (abort === mine && now) store.set({ ...now, ...change }, "person");
  };
  store.set({ files, bytes, sent: 0, failure: null, result: null }, "person");
  try {
    const result = await sendFiles(files, options, (sent) => tell({ sent }), mine.signal);
    tell({ result, sent: 1 });
  } catch (failure) {
    const isAbort = failure instanceof DOMException && failure.name === "AbortError";
    if (!isAbort) tell({ failure: failure instanceof Error ? failure : new ApiError(0, "Error", String(failure)) });
  }
}

export function cancelIncoming(): void {
  abort?.abort();
  abort = null;
  store.set(null, "person");
}
