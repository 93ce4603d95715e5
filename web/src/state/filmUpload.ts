/** Films of a board, chosen and on their way into the studio. */

import { sendFilms, type Calibration, type CalibrationOptions } from "../api/calibrations";
import type { DroppedFile } from "../api/imports";
import { nameFiles, type Film } from "../model/films";
import { createUpload, UNSENT, type Upload } from "./upload";

export interface FilmUpload extends Upload<Calibration> {
  readonly name: string;
  readonly films: readonly Film[];
  readonly lenses: readonly DroppedFile[];
  /** Null: as the form has them. */
  readonly options: CalibrationOptions | null;
}

const EMPTY: FilmUpload = { name: "Cameras", films: [], lenses: [], options: null, ...UNSENT };

const upload = createUpload<FilmUpload, FilmUpload>(EMPTY);

export const useFilmUpload = upload.use;
export const changeFilmUpload = upload.change;
export const endFilmUpload = upload.end;

/** Send what was chosen. */
export const sendChosenFilms = (options: CalibrationOptions): Promise<void> =>
  upload.work({ sent: 0, result: null }, async ({ name, films, lenses }, tell, signal) => ({
    result: await sendFilms(nameFiles(films, lenses), name.trim() || EMPTY.name, options, (sent) => tell({ sent }), signal),
    sent: 1,
  }));

/** Stop sending; what was chosen stays chosen. */
export function stopFilmUpload(): void {
  upload.stop();
  upload.change({ sent: null });
}
