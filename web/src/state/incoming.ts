/** A recording on its way into the studio. */

import { sendFiles, type DroppedFile, type ImportOptions } from "../api/imports";
import type { Import } from "../api/types";
import { countBytes, createUpload, UNSENT, type FileUpload } from "./upload";

const upload = createUpload<FileUpload<Import>, null>(null);

export const useIncoming = upload.use;
export const cancelIncoming = upload.end;

/** Send files; whatever was being sent before is called off. */
export function sendIncoming(files: readonly DroppedFile[], options: ImportOptions = {}): Promise<void> {
  upload.stop();
  upload.choose({ files, bytes: countBytes(files), ...UNSENT });
  return upload.work({ sent: 0 }, async (chosen, tell, signal) => ({ result: await sendFiles(chosen.files, options, (sent) => tell({ sent }), signal), sent: 1 }));
}
