/** A moving scan on its way into the studio. */

import type { DroppedFile } from "../api/imports";
import { sendMovingScan, type MovingScanAdded, type MovingScanOptions } from "../api/movingScans";
import { countBytes, createUpload, UNSENT, type FileUpload } from "./upload";

const upload = createUpload<FileUpload<MovingScanAdded>, null>(null);

export const useMovingUpload = upload.use;
export const endMovingUpload = upload.end;

/** Files were dropped or chosen; nothing is sent yet. */
export function chooseMovingScan(files: readonly DroppedFile[]): void {
  if (files.length === 0 || (upload.get()?.sent ?? null) !== null) return;
  upload.choose({ files, bytes: countBytes(files), ...UNSENT });
}

export const sendChosenMovingScan = (options: MovingScanOptions): Promise<void> =>
  upload.work({ sent: 0 }, async ({ files }, tell, signal) => ({ result: await sendMovingScan(files, options, (sent) => tell({ sent }), signal), sent: 1 }));
