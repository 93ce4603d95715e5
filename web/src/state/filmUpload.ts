/** Films of a board, chosen and on their way into the studio; kept outside the pages so that walking about loses nothing. */

import { useSyncExternalStore } from "react";
import { sendFilms, type Calibration, type CalibrationOptions } from "../api/calibrations";
import { ApiError } from "../api/client";
import type { DroppedFile } from "../api/imports";
import { nameFiles, type Film } from "../model/films";
import { createStore } from "./store";

export interface FilmUpload {
  readonly name: string;
  readonly films: readonly Film[];
  readonly lenses: readonly DroppedFile[];
  /** Null: as the form has them. */
  readonly options: CalibrationOptions | null;
  /** Null until somebody has said to send them; 0..1; 1 means that the server is looking at them. */
  readonly sent: number | null;
  readonly failure: Error | null;
  readonly result: Calibration | null;
}

const EMPTY: FilmUpload = { name: "Cameras", films: [], lenses: [], options: null, sent: null, failure: null, result: null };

const store = createStore<FilmUpload>(EMPTY);
let abort: AbortController | null = null;

export const useFilmUpload = (): FilmUpload => useSyncExternalStore((tell) => store.watch(tell), store.get);

export const changeFilmUpload = (change: Partial<FilmUpload>): void => store.set({ ...store.get(), ...change }, "person");

/** Send what was chosen. */
export async function sendChosenFilms(options: CalibrationOptions): Promise<void> {
  abort?.abort();
  const mine = new AbortController();
  abort = mine;
  const { name, films, lenses } = store.get();
  const tell = (change: Partial<FilmUpload>): void => {
    if (abort === mine) changeFilmUpload(change);
  };
  tell({ sent: 0, failure: null, result: null });
  try {
    const result = await sendFilms(nameFiles(films, lenses), name.trim() || EMPTY.name, options, (sent) => tell({ sent }), mine.signal);
    tell({ result, sent: 1 });
  } catch (failure) {
    const isAbort = failure instanceof DOMException && failure.name === "AbortError";
    if (!isAbort) tell({ sent: null, failure: failure instanceof Error ? failure : new ApiError(0, "Error", String(failure)) });
  }
}

/** Stop sending; what was chosen stays chosen. */
export function stopFilmUpload(): void {
  abort?.abort();
  abort = null;
  changeFilmUpload({ sent: null });
}

/** Forget what was chosen. */
export function endFilmUpload(): void {
  abort?.abort();
  abort = null;
  store.set(EMPTY, "person");
}
