import { expect, test, vi } from "vitest";
import { createDecisionLog, hasWaitingDecisions, type DecisionOutcome, type LoggedDecision, type Standing } from "./decisionLog";

class MemoryStorage implements Storage {
  private readonly items = new Map<string, string>();
  get length() {
    return this.items.size;
  }
  key = (at: number) => [...this.items.keys()][at] ?? null;
  getItem = (name: string) => this.items.get(name) ?? null;
  setItem = (name: string, value: string) => void this.items.set(name, value);
  removeItem = (name: string) => void this.items.delete(name);
  clear = () => this.items.clear();
}

/** Stores each operation once, as the real one does, and answers a repeated one alike. */
function aServer() {
  const stored: (LoggedDecision & { id: string })[] = [];
  let isDown = false;
  return {
    stored,
    setDown: (down: boolean) => (isDown = down),
    send: (decision: LoggedDecision): Promise<DecisionOutcome> => {
      if (isDown) return Promise.resolve({ kind: "unreachable" });
      const before = stored.find((one) => one.operationId === decision.operationId);
      const made = before ?? { ...decision, id: `d${stored.length + 1}` };
      if (!before) stored.push(made);
      return Promise.resolve({ kind: "saved", decisionId: made.id });
    },
  };
}

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 5));
const about = (registrationId: string, decision: Standing = "accept") => ({ registrationId, name: registrationId, decision, reasons: [], seconds: 1, undoes: null });
const undo = (registrationId: string, operationId: string) => ({ ...about(registrationId), decision: "undo" as const, undoes: { operationId } });

test("decisions arrive in the order made, and nothing waits afterwards", async () => {
  const server = aServer();
  const storage = new MemoryStorage();
  const log = createDecisionLog({ send: server.send, storage, account: "anna" });
  for (const name of ["a", "b", "c", "d"]) log.add(about(name));
  expect(log.status().waiting).toBe(4);
  await settled();
  expect(server.stored.map((one) => one.registrationId)).toEqual(["a", "b", "c", "d"]);
  expect(log.status().waiting).toBe(0);
  expect(hasWaitingDecisions(storage, "anna")).toBe(false);
});

test("a decision is in the browser before anything is sent, and a tab that dies loses nothing and doubles nothing", async () => {
  const server = aServer();
  const storage = new MemoryStorage();
  // The answer to the first never comes: the server has it, the tab does not know.
  const dying = createDecisionLog({ send: (decision) => (void server.send(decision), new Promise(() => undefined)), storage, account: "anna" });
  dying.add(about("a"));
  expect(hasWaitingDecisions(storage, "anna")).toBe(true);
  dying.add(about("b", "reject"));
  dying.stop();
  const again = createDecisionLog({ send: server.send, storage, account: "anna" });
  expect(again.waiting().map((one) => one.registrationId)).toEqual(["a", "b"]);
  again.flush();
  await settled();
  expect(server.stored.map((one) => [one.registrationId, one.decision])).toEqual([["a", "accept"], ["b", "reject"]]);
  expect(hasWaitingDecisions(storage, "anna")).toBe(false);
});

test("an undo made while the network is away follows its decision and names it", async () => {
  const server = aServer();
  const storage = new MemoryStorage();
  server.setDown(true);
  const log = createDecisionLog({ send: server.send, storage, account: "anna" });
  const operation = log.add(about("a"));
  log.add(undo("a", operation));
  await settled();
  expect(log.status()).toMatchObject({ waiting: 2, isOffline: true });
  server.setDown(false);
  log.flush();
  await settled();
  expect(server.stored.map((one) => [one.decision, one.undoes])).toEqual([["accept", null], ["undo", { decisionId: "d1" }]]);
  log.add(undo("a", operation));
  await settled();
  expect(server.stored.at(-1)?.undoes, "a decision that the server has is named by its id").toEqual({ decisionId: "d1" });
});

test("an undo knows its decision also when the tab dies between the two", async () => {
  const server = aServer();
  const storage = new MemoryStorage();
  const log = createDecisionLog({
    storage,
    account: "anna",
    send: (decision) => (decision.decision === "undo" ? new Promise(() => undefined) : server.send(decision)),
  });
  log.add(undo("a", log.add(about("a"))));
  await settled();
  log.stop();
  const again = createDecisionLog({ send: server.send, storage, account: "anna" });
  again.flush();
  await settled();
  expect(server.stored.at(-1)?.undoes).toEqual({ decisionId: "d1" });
});

test("what is refused stays, says why, lets the others through, and can be dropped with its undo", async () => {
  const storage = new MemoryStorage();
  const sent: string[] = [];
  const log = createDecisionLog({
    storage,
    account: "anna",
    send: (decision) => {
      sent.push(decision.registrationId);
      return Promise.resolve(decision.registrationId === "gone" ? { kind: "refused", reason: "There is no such registration." } : { kind: "saved", decisionId: "x" });
    },
  });
  const operation = log.add(about("gone"));
  log.add(undo("gone", operation));
  log.add(about("here"));
  await settled();
  expect(sent).toEqual(["gone", "here"]);
  expect(log.status().refusals.get(operation)?.reason).toBe("There is no such registration.");
  log.discard(operation);
  expect(log.status()).toMatchObject({ waiting: 0 });
  expect(hasWaitingDecisions(storage, "anna")).toBe(false);
});

test("after a login has ended nothing is asked until the person is back, and then all goes out", async () => {
  const server = aServer();
  let isOut = true;
  const send = vi.fn((decision: LoggedDecision) => (isOut ? Promise.resolve<DecisionOutcome>({ kind: "held" }) : server.send(decision)));
  const log = createDecisionLog({ send, storage: new MemoryStorage(), account: "anna" });
  log.add(about("a"));
  await settled();
  log.add(about("b"));
  await settled();
  expect(send).toHaveBeenCalledTimes(1);
  expect(log.status()).toMatchObject({ isHeld: true, waiting: 2 });
  isOut = false;
  log.flush();
  await settled();
  expect(server.stored.map((one) => one.registrationId)).toEqual(["a", "b"]);
});

test("each person has a log of their own, and two tabs do not write over each other's", () => {
  const storage = new MemoryStorage();
  const never = (): Promise<DecisionOutcome> => new Promise(() => undefined);
  createDecisionLog({ send: never, storage, account: "anna" }).add(about("a"));
  createDecisionLog({ send: never, storage, account: "anna" }).add(about("b"));
  expect(createDecisionLog({ send: never, storage, account: "anna" }).waiting()).toHaveLength(2);
  expect(createDecisionLog({ send: never, storage, account: "ben" }).waiting()).toHaveLength(0);
});

test("a clock that jumps back does not change the order", () => {
  const storage = new MemoryStorage();
  const times = [5000, 1000, 3000];
  const log = createDecisionLog({ send: () => new Promise(() => undefined), storage, account: "anna", now: () => times.shift() ?? 0 });
  for (const name of ["a", "b", "c"]) log.add(about(name));
  log.stop();
  const again = createDecisionLog({ send: () => new Promise(() => undefined), storage, account: "anna" });
  expect(again.waiting().map((one) => one.registrationId)).toEqual(["a", "b", "c"]);
});

test("a browser that keeps nothing is named, and the decision still goes out", async () => {
  const server = aServer();
  const full = new MemoryStorage();
  full.setItem = () => {
    throw new DOMException("full", "QuotaExceededError");
  };
  const log = createDecisionLog({ send: server.send, storage: full, account: "anna" });
  log.add(about("a"));
  expect(log.status().isKept).toBe(false);
  await settled();
  expect(server.stored).toHaveLength(1);
});
