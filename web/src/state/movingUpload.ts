/** A moving scan on its way into the studio, kept outside the pages so that walking about does not stop it. */

import { useSyncExternalStore } from "react";
import { ApiError } from "../api/client";
import type { DroppedFile } from "../api/imports";
import { sendMovingScan, type MovingScanAdded, type MovingScanOptions } from "../api/movingScans";
import { createStore } from "./store";

export interface MovingUpload {
  readonly files: readonly DroppedFile[];
  readonly bytes: number;
  /** Null until somebody has said to send them; 0..1; 1 means that the server is reading them. */
  readonly sent: number | null;
  readonly failure: Error | null;
  readonly result: MovingScanAdded | null;
}

const store = createStore<MovingUpload | null>(null);
let abort: AbortController | null = null;

export const useMovingUpload = (): MovingUpload | null => useSyncExternalStore((tell) => store.watch(tell), store.get);

/** Files were dropped or chosen; nothing is sent yet. */
export function chooseMovingScan(files: readonly DroppedFile[]): void {
  if (files.length === 0 || (store.get()?.sent ?? null) !== null) return;
  store.set({ files, bytes: files.reduce((sum, { file }) => sum + file.size, 0), sent: null, failure: null, result: null }, "person");
}

export async function sendChosenMovingScan(options: MovingScanOptions): Promise<void> {
  const chosen = store.get();
  if (!chosen) return;
  abort?.abort();
  const mine = new AbortController();
  abort = mine;
  const tell = (change: Partial<MovingUpload>): void => {
    const now = store.get();
    if (abort === mine && now) store.set({ ...now, ...change }, "person");
  };
  tell({ sent: 0, failure: null });
  try {
    tell({ result: await sendMovingScan(chosen.files, options, (sent) => tell({ sent }), mine.signal), sent: 1 });
  } catch (failure) {
    const isAbort = failure instanceof DOMException && failure.name === "AbortError";
    if (!isAbort) tell({ sent: null, failure: failure instanceof Error ? failure : new ApiError(0, "Error", String(failure)) });
  }
}

export function endMovingUpload(): void {
  abort?.abort();
  abort = null;
  store.set(null, "person");
}
