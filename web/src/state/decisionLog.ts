/**
 * The way of every decision of a curator to the server: written into this browser before anything else happens, sent in
 * the order made, one at a time, taken out when the server has it. A closed tab, a dead network or an ended login only
 * makes it wait.
 */

export type Standing = "accept" | "reject" | "unsure";

/** One decision, or one taken back, that the server has not acknowledged. */
export interface LoggedDecision {
  readonly operationId: string;
  readonly registrationId: string;
  /** For people: the scan's name. */
  readonly name: string;
  readonly decision: Standing | "undo";
  readonly reasons: readonly string[];
  /** How long it was looked at, s. */
  readonly seconds: number | null;
  /** What an undo takes back: by the server's id when that is known, else by its operation. */
  readonly undoes: { readonly decisionId: string } | { readonly operationId: string } | null;
  /** ms since 1970 by this browser's clock; only an order. */
  readonly madeAt: number;
}

/** What the server did with one. */
export type DecisionOutcome =
  | { readonly kind: "saved"; readonly decisionId: string }
  | { readonly kind: "refused"; readonly reason: string }
  | { readonly kind: "unreachable"; readonly reason?: string }
  | { readonly kind: "held" };

export type SendDecision = (decision: LoggedDecision) => Promise<DecisionOutcome>;

export interface DecisionStatus {
  readonly waiting: number;
  readonly isSending: boolean;
  readonly isOffline: boolean;
  /** Why a server that was reached cannot take anything now. */
  readonly trouble: string;
  /** True until the person is logged in again. */
  readonly isHeld: boolean;
  /** False when the browser refuses to keep what waits. */
  readonly isKept: boolean;
  /** What the server does not take, by operation. */
  readonly refusals: ReadonlyMap<string, { readonly decision: LoggedDecision; readonly reason: string }>;
}

export interface DecisionLog {
  add: (decision: Omit<LoggedDecision, "operationId" | "madeAt">) => string;
  /** What waits, oldest first. */
  waiting: () => readonly LoggedDecision[];
  /** Drop what the server refuses to take. */
  discard: (operationId: string) => void;
  flush: () => void;
  status: () => DecisionStatus;
  watch: (watcher: () => void) => () => void;
  stop: () => void;
}

/** Each person's own. */
export const DECISIONS = "handloom/decisions/";
const RETRY_MS = [1000, 2000, 4000, 8000, 15000] as const;

/** Whether somebody's decisions wait in this browser. */
export function hasWaitingDecisions(storage: Storage, account: string): boolean {
  const prefix = `${DECISIONS}${account}/`;
  return Array.from({ length: storage.length }, (_, at) => storage.key(at)).some((name) => name?.startsWith(prefix));
}

/** An entry of its own for each, so that two tabs never write over each other's. */
const entryName = (account: string, { madeAt, operationId }: LoggedDecision): string => `${DECISIONS}${account}/${String(madeAt).padStart(15, "0")}-${operationId}`;

function load(storage: Storage, account: string): LoggedDecision[] {
  const prefix = `${DECISIONS}${account}/`;
  const names = Array.from({ length: storage.length }, (_, at) => storage.key(at) ?? "").filter((name) => name.startsWith(prefix));
  return names.sort().flatMap((name) => {
    try {
      const found = JSON.parse(storage.getItem(name) ?? "null") as LoggedDecision | null;
      return found && typeof found.operationId === "string" && typeof found.registrationId === "string" ? [found] : [];
    } catch {
      return [];
    }
  });
}

interface Parts {
  send: SendDecision;
  storage: Storage;
  account: string;
  newId?: () => string;
  now?: () => number;
}

export function createDecisionLog({ send, storage, account, newId = () => crypto.randomUUID(), now = Date.now }: Parts): DecisionLog {
  let pending = load(storage, account);
  let newest = pending.at(-1)?.madeAt ?? 0;
  const refusals = new Map<string, { decision: LoggedDecision; reason: string }>();
  const ids = new Map<string, string>();
  const watchers = new Set<() => void>();
  let sending: string | null = null;
  let failures = 0;
  let trouble = "";
  let isHeld = false;
  let isKept = true;
  let isStopped = false;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let status = describe();

  function describe(): DecisionStatus {
    return {
      waiting: pending.length,
      isSending: sending !== null,
      isOffline: failures > 0,
      trouble: failures > 0 ? trouble : "",
      isHeld,
      isKept,
      refusals: new Map(refusals),
    };
  }

  function tell(): void {
    status = describe();
    watchers.forEach((watcher) => watcher());
  }

  function keep(decision: LoggedDecision): void {
    try {
      storage.setItem(entryName(account, decision), JSON.stringify(decision));
      isKept = true;
    } catch {
      isKept = false;
    }
  }

  function drop(operationId: string): void {
    const gone = pending.find((one) => one.operationId === operationId);
    if (gone) storage.removeItem(entryName(account, gone));
    pending = pending.filter((one) => one.operationId !== operationId);
    refusals.delete(operationId);
  }

  /** Undos that wait for a decision learn its id, also for the case that this tab dies before they are sent. */
  function learnId(operationId: string, decisionId: string): void {
    ids.set(operationId, decisionId);
    pending = pending.map((one) => {
      if (!one.undoes || !("operationId" in one.undoes) || one.undoes.operationId !== operationId) return one;
      const known = { ...one, undoes: { decisionId } };
      keep(known);
      return known;
    });
  }

  async function drain(): Promise<void> {
    const next = pending.find((one) => !refusals.has(one.operationId) && !(one.undoes && "operationId" in one.undoes && refusals.has(one.undoes.operationId)));
    if (!next || sending !== null || isHeld || isStopped) return;
    sending = next.operationId;
    tell();
    const outcome = await send(next);
    sending = null;
    if (isStopped) return;
    switch (outcome.kind) {
      case "saved":
        failures = 0;
        learnId(next.operationId, outcome.decisionId);
        drop(next.operationId);
        break;
      case "refused":
        failures = 0;
        refusals.set(next.operationId, { decision: next, reason: outcome.reason });
        break;
      case "held":
        isHeld = true;
        tell();
        return;
      case "unreachable":
        failures += 1;
        trouble = outcome.reason ?? "";
        clearTimeout(timer);
        timer = setTimeout(() => void drain(), RETRY_MS[Math.min(failures, RETRY_MS.length) - 1]);
        tell();
        return;
    }
    tell();
    void drain();
  }

  return {
    add(decision) {
      // A clock that was set back does not change the order.
      newest = Math.max(newest + 1, now());
      const known = decision.undoes && "operationId" in decision.undoes ? ids.get(decision.undoes.operationId) : undefined;
      const undoes = known === undefined ? decision.undoes : { decisionId: known };
      const logged: LoggedDecision = { ...decision, undoes, operationId: newId(), madeAt: newest };
      keep(logged);
      pending = [...pending, logged];
      tell();
      if (failures === 0) void drain();
      return logged.operationId;
    },
    waiting: () => pending,
    discard(operationId) {
      // An undo of something that was never taken has nothing to undo.
      const undos = pending.filter((one) => one.undoes && "operationId" in one.undoes && one.undoes.operationId === operationId);
      for (const one of [operationId, ...undos.map((undo) => undo.operationId)]) drop(one);
      tell();
    },
    flush() {
      isHeld = false;
      clearTimeout(timer);
      void drain();
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
