/** Scans on their way into the studio, kept outside the pages so that walking about does not stop an upload. */

import { useSyncExternalStore } from "react";
import { ApiError } from "../api/client";
import type { DroppedFile } from "../api/imports";
import { measureScans, sendScans, type ScansAdded, type ScansMeasured, type ScanUploadOptions } from "../api/scans";
import { createStore } from "./store";

export interface ScanUpload {
  readonly files: readonly DroppedFile[];
  readonly bytes: number;
  /** Sizes of the scans in them; null while the server measures. */
  readonly measured: ScansMeasured | null;
  /** Null until somebody has said to send them; 0..1; 1 means that the server is reading them. */
  readonly sent: number | null;
  readonly failure: Error | null;
  readonly result: ScansAdded | null;
}

const store = createStore<ScanUpload | null>(null);
let abort: AbortController | null = null;

export const useScanUpload = (): ScanUpload | null => useSyncExternalStore((tell) => store.watch(tell), store.get);

/** Files were dropped or chosen: they are measured, and nothing is stored yet. */
export function chooseScans(files: readonly DroppedFile[]): void {
  if (files.length === 0 || (store.get()?.sent ?? null) !== null) return;
  store.set({ files, bytes: files.reduce((sum, { file }) => sum + file.size, 0), measured: null, sent: null, failure: null, result: null }, "person");
  void measureChosenScans();
}

export const measureChosenScans = (): Promise<void> =>
  work({ measured: null }, async (files, tell, signal) => tell({ measured: await measureScans(files, () => undefined, signal) }));

export const sendChosenScans = (options: ScanUploadOptions): Promise<void> =>
  work({ sent: 0, result: null }, async (files, tell, signal) => tell({ result: await sendScans(files, options, (sent) => tell({ sent }), signal), sent: 1 }));

type Tell = (change: Partial<ScanUpload>) => void;

/** One request about the chosen files; a newer one, or an end, stops it. */
async function work(begin: Partial<ScanUpload>, act: (files: readonly DroppedFile[], tell: Tell, signal: AbortSignal) => Promise<void>): Promise<void> {
  const chosen = store.get();
  if (!chosen) return;
  abort?.abort();
  const mine = new AbortController();
  abort = mine;
  const tell: Tell = (change) => {
    const now = store.get();
    if (abort === mine && now) store.set({ ...now, ...change }, "person");
  };
  tell({ ...begin, failure: null });
  try {
    await act(chosen.files, tell, mine.signal);
  } catch (failure) {
    const isAbort = failure instanceof DOMException && failure.name === "AbortError";
    if (!isAbort) tell({ sent: null, failure: failure instanceof Error ? failure : new ApiError(0, "Error", String(failure)) });
  }
}

export function endScanUpload(): void {
  abort?.abort();
  abort = null;
  store.set(null, "person");
}
