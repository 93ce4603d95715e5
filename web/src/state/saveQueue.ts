/**
 * The way of every annotation to the server: one at a time for each hand and frame, kept in the journal until
 * acknowledged, sent again when the server does not answer, held back when somebody else was faster.
 */

import type { KeptPoint } from "../model/pose";
import type { Journal, PendingSave } from "./journal";

/** What the server did with a save. */
export type Outcome =
  /** `revision` is null when it was deleted; `version` counts a deletion too. */
  | { readonly kind: "saved"; readonly revision: number | null; readonly version?: number | null }
  | { readonly kind: "conflict"; readonly theirs: Theirs }
  | { readonly kind: "refused"; readonly reason: string }
  /** No answer, or one that says why the server cannot take it now; it is sent again. */
  | { readonly kind: "unreachable"; readonly reason?: string }
  /** Nobody is logged in, or somebody else: it waits for the person who made it. */
  | { readonly kind: "held" };

/** The version that the server holds; points null when it was deleted. */
export interface Theirs {
  readonly points: KeptPoint[] | null;
  readonly revision: number | null;
  /** Who made it, where it is there and known. */
  readonly author?: string | null;
}

/** A version that somebody else stored just now; `version` counts a deletion too. */
export interface Heard extends Theirs {
  readonly version: number;
}

export type Send = (key: string, save: PendingSave) => Promise<Outcome>;

export interface SaveStatus {
  /** Hands whose newest version the server does not have yet. */
  readonly waiting: number;
  readonly isSending: boolean;
  readonly isOffline: boolean;
  /** Why the server that was reached cannot take anything now (a full disk); empty when it does not answer at all. */
  readonly trouble: string;
  /** True until the person is logged in again; nothing is sent meanwhile. */
  readonly isHeld: boolean;
  /** False when the browser refuses to keep what waits. */
  readonly isKept: boolean;
  readonly conflicts: ReadonlyMap<string, Theirs>;
  readonly refusals: ReadonlyMap<string, string>;
  readonly lastSavedAt: number | null;
}

export interface SaveQueue {
  /**
   * The server's revisions as loaded; what still waits keeps the revision it was made on. False, and nothing is learnt,
   * when a save has overtaken the loading: load again. `isFinal` takes it as it is, because others may have deleted.
   */
  learn: (revisions: ReadonlyMap<string, number>, isFinal?: boolean) => boolean;
  /**
   * Somebody else has stored a version. "news": learnt, and to be shown. "known": no newer than what is here, or shown
   * where a conflict is settled. "busy": something of the person's own waits; ask again when the status has changed.
   */
  hear: (key: string, heard: Heard) => "news" | "known" | "busy";
  /** Nothing is known of a hand any more; false when something of the person's own waits. */
  forget: (key: string) => boolean;
  put: (key: string, points: KeptPoint[] | null) => void;
  /** What waits, newest version by key. */
  waiting: () => ReadonlyMap<string, KeptPoint[] | null>;
  /** Settle a conflict with these points (null deletes); "theirs" drops what waits. */
  settle: (key: string, choice: KeptPoint[] | null | "theirs") => void;
  /** Drop what the server refuses to take. */
  discard: (key: string) => void;
  /** Try everything now. */
  flush: () => void;
  status: () => SaveStatus;
  watch: (watcher: () => void) => () => void;
  stop: () => void;
}

/** Of hands and of key frames together; a drag that has not ended is not saved either. */
export function joinStatus(hands: SaveStatus, keys: SaveStatus, isDrawing: boolean): SaveStatus {
  return {
    ...hands,
    waiting: hands.waiting + keys.waiting + (isDrawing ? 1 : 0),
    isSending: hands.isSending || keys.isSending,
    isOffline: hands.isOffline || keys.isOffline,
    trouble: hands.trouble || keys.trouble,
    isHeld: hands.isHeld || keys.isHeld,
    isKept: hands.isKept && keys.isKept,
  };
}

const RETRY_MS = [1000, 2000, 4000, 8000, 15000] as const;

export function createSaveQueue(send: Send, journal: Journal, newId: () => string = () => crypto.randomUUID()): SaveQueue {
  const pending = journal.load();
  const revisions = new Map<string, number | null>();
  /** Newest version that was seen of each hand, also of one that is deleted. */
  const seen = new Map<string, number>();
  const sending = new Set<string>();
  const conflicts = new Map<string, Theirs>();
  const refusals = new Map<string, string>();
  const watchers = new Set<() => void>();
  let failures = 0;
  let trouble = "";
  let isHeld = false;
  let isKept = true;
  let lastSavedAt: number | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let isStopped = false;
  let status: SaveStatus = describe();

  function describe(): SaveStatus {
    return {
      waiting: pending.size,
      isSending: sending.size > 0,
      isOffline: failures > 0,
      trouble: failures > 0 ? trouble : "",
      isHeld,
      isKept,
      conflicts: new Map(conflicts),
      refusals: new Map(refusals),
      lastSavedAt,
    };
  }

  function tell(): void {
    status = describe();
    watchers.forEach((watcher) => watcher());
  }

  function keep(key: string, saves: readonly PendingSave[]): void {
    if (saves.length === 0) pending.delete(key);
    else pending.set(key, [...saves]);
    isKept = journal.keep(key, saves);
  }

  function note(key: string, version: number | null | undefined): void {
    if (version && version > (seen.get(key) ?? 0)) seen.set(key, version);
  }

  async function drain(key: string): Promise<void> {
    const save = pending.get(key)?.[0];
    if (!save || sending.has(key) || conflicts.has(key) || refusals.has(key) || isHeld || isStopped) return;
    sending.add(key);
    if (!save.isSent) keep(key, [{ ...save, isSent: true }, ...(pending.get(key) ?? []).slice(1)]);
    tell();
    const outcome = await send(key, save);
    sending.delete(key);
    if (isStopped) return;
    const rest = (pending.get(key) ?? []).filter((one) => one.operationId !== save.operationId);
    switch (outcome.kind) {
      case "saved":
        failures = 0;
        lastSavedAt = Date.now();
        revisions.set(key, outcome.revision);
        note(key, outcome.version ?? outcome.revision);
        keep(key, rest.map((one) => ({ ...one, base: outcome.revision })));
        break;
      case "conflict":
        failures = 0;
        conflicts.set(key, outcome.theirs);
        note(key, outcome.theirs.revision);
        break;
      case "refused":
        failures = 0;
        refusals.set(key, outcome.reason);
        break;
      case "held":
        isHeld = true;
        tell();
        return;
      case "unreachable":
        failures += 1;
        trouble = outcome.reason ?? "";
        clearTimeout(timer);
        timer = setTimeout(drainAll, RETRY_MS[Math.min(failures, RETRY_MS.length) - 1]);
        tell();
        return;
    }
    tell();
    // Others were held back while the server was away: what was made since its last try has no other call.
    drainAll();
  }

  function drainAll(): void {
    for (const key of [...pending.keys()]) void drain(key);
  }

  return {
    learn(known, isFinal = true) {
      const isOvertaken = [...revisions].some(([key, revision]) => revision !== null && revision > (known.get(key) ?? 0));
      drainAll();
      if (isOvertaken && !isFinal) return false;
      revisions.clear();
      known.forEach((revision, key) => {
        revisions.set(key, revision);
        note(key, revision);
      });
      return true;
    },
    hear(key, { version, ...theirs }) {
      if (version <= (seen.get(key) ?? 0)) return "known";
      if (conflicts.has(key)) {
        seen.set(key, version);
        conflicts.set(key, theirs);
        tell();
        return "known";
      }
      if (pending.has(key)) return "busy";
      seen.set(key, version);
      revisions.set(key, theirs.revision);
      return "news";
    },
    forget(key) {
      if (pending.has(key)) return false;
      revisions.delete(key);
      seen.delete(key);
      return true;
    },
    put(key, points) {
      const saves = pending.get(key) ?? [];
      const first = saves[0];
      const isAnswered = conflicts.has(key) || refusals.has(key);
      const flying = first?.isSent && !isAnswered ? [first] : [];
      // Behind the one on its way only the newest version has to follow.
      const base = flying.length > 0 ? null : (first?.base ?? revisions.get(key) ?? null);
      refusals.delete(key);
      keep(key, [...flying, { operationId: newId(), points, base }]);
      tell();
      if (failures === 0) void drain(key);
    },
    waiting: () => new Map([...pending].map(([key, saves]) => [key, saves.at(-1)?.points ?? null])),
    settle(key, choice) {
      const theirs = conflicts.get(key);
      if (!theirs) return;
      conflicts.delete(key);
      revisions.set(key, theirs.revision);
      keep(key, choice === "theirs" ? [] : [{ operationId: newId(), points: choice, base: theirs.revision }]);
      tell();
      void drain(key);
    },
    discard(key) {
      refusals.delete(key);
      keep(key, []);
      tell();
    },
    flush() {
      isHeld = false;
      clearTimeout(timer);
      drainAll();
    },
    status: () => status,
    watch(watcher) {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
    stop() {
      isStopped = true;
      clearTimeout(timer);
    },
  };
}
