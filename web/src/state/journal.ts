/** What is not yet acknowledged by the server, kept where a reload or a crash does not reach it. */

import type { KeptPoint } from "../model/pose";

/** One save that the server has not acknowledged. `points` null deletes the annotation. */
export interface PendingSave {
  readonly operationId: string;
  readonly points: KeptPoint[] | null;
  /** Revision that the person saw when making it; null when there was no annotation. */
  readonly base: number | null;
  /** It has left at least once, so the server may have it although no answer came: it must not be replaced. */
  readonly isSent?: boolean;
}

/** Each person's own: nobody's work is sent in the name of somebody else who uses this browser after them. */
export const UNSAVED = "handloom/unsaved/";

/** Recordings of which somebody's work waits in this browser. */
export function findWaiting(storage: Storage, account: string): string[] {
  const prefix = `${UNSAVED}${account}/`;
  const names = Array.from({ length: storage.length }, (_, index) => storage.key(index) ?? "");
  return [...new Set(names.filter((name) => name.startsWith(prefix)).map((name) => name.slice(prefix.length).split("/")[0] ?? ""))];
}

export interface Journal {
  load: () => Map<string, PendingSave[]>;
  /** Returns false when it could not be kept (storage full or forbidden). */
  keep: (key: string, saves: readonly PendingSave[]) => boolean;
}

/** In localStorage, because it is written before the next line runs; IndexedDB may lose the last gesture on a crash. */
export function createJournal(storage: Storage, account: string, recording: string): Journal {
  const prefix = `${UNSAVED}${account}/${recording}/`;
  return {
    load() {
      const found = new Map<string, PendingSave[]>();
      for (let index = 0; index < storage.length; index += 1) {
        const name = storage.key(index);
        if (!name?.startsWith(prefix)) continue;
        try {
          const saves = JSON.parse(storage.getItem(name) ?? "[]") as PendingSave[];
          if (Array.isArray(saves) && saves.length > 0) found.set(name.slice(prefix.length), saves);
        } catch {
          storage.removeItem(name);
        }
      }
      return found;
    },
    keep(key, saves) {
      try {
        if (saves.length === 0) storage.removeItem(prefix + key);
        else storage.setItem(prefix + key, JSON.stringify(saves));
        return true;
      } catch {
        return false;
      }
    },
  };
}
