/** Scans on their way into the studio. */

import type { DroppedFile } from "../api/imports";
import { measureScans, sendScans, type ScansAdded, type ScansMeasured, type ScanUploadOptions } from "../api/scans";
import { countBytes, createUpload, UNSENT, type FileUpload } from "./upload";

export interface ScanUpload extends FileUpload<ScansAdded> {
  /** Sizes of the scans in them; null while the server measures. */
  readonly measured: ScansMeasured | null;
}

const upload = createUpload<ScanUpload, null>(null);

export const useScanUpload = upload.use;
export const endScanUpload = upload.end;

/** Files were dropped or chosen: they are measured, and nothing is stored yet. */
export function chooseScans(files: readonly DroppedFile[]): void {
  if (files.length === 0 || (upload.get()?.sent ?? null) !== null) return;
  upload.choose({ files, bytes: countBytes(files), measured: null, ...UNSENT });
  void measureChosenScans();
}

export const measureChosenScans = (): Promise<void> =>
  upload.work({ measured: null }, async ({ files }, _, signal) => ({ measured: await measureScans(files, () => undefined, signal) }));

export const sendChosenScans = (options: ScanUploadOptions): Promise<void> =>
  upload.work({ sent: 0, result: null }, async ({ files }, tell, signal) => ({ result: await sendScans(files, options, (sent) => tell({ sent }), signal), sent: 1 }));
