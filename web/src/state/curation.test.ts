import { expect, test } from "vitest";
import type { Registration } from "../api/registrations";
import { decisionOf, openCuration, shownIn, soonShown } from "./curation";
import type { DecisionLog, LoggedDecision } from "./decisionLog";

const registration = (id: string, more: Partial<Registration> = {}): Registration =>
  ({ id, scan: { name: `scan ${id}` }, my_decision: null, my_decision_id: null, ...more }) as Registration;

function aLog(before: readonly Partial<LoggedDecision>[] = []) {
  const added: Omit<LoggedDecision, "operationId" | "madeAt">[] = [];
  const log = {
    add: (decision: (typeof added)[number]) => `op${added.push(decision)}`,
    waiting: () => before as LoggedDecision[],
  } as unknown as DecisionLog;
  return { log, added };
}

const CHOICE = { queue: "undecided", order: "likely_failures" } as const;

function opened(names: string, more: Parameters<typeof aLog>[0] = []) {
  const { log, added } = aLog(more);
  let time = 0;
  const curation = openCuration(log, CHOICE, () => time);
  curation.append([...names].map((name) => registration(name)), false);
  return { curation, added, pass: (seconds: number) => (time += 1000 * seconds), shown: () => shownIn(curation.store.get())?.id ?? null };
}

test("a decision is logged with the time it took, and the next one is shown", () => {
  const { curation, added, pass, shown } = opened("abc");
  pass(2);
  curation.decide("accept");
  expect(shown()).toBe("b");
  pass(3);
  curation.decide("reject", ["slid"]);
  expect(added).toMatchObject([
    { registrationId: "a", decision: "accept", seconds: 2, reasons: [] },
    { registrationId: "b", decision: "reject", seconds: 3, reasons: ["slid"] },
  ]);
  expect(shown()).toBe("c");
});

test("undo goes back to where it was decided and takes just that back, again and again", () => {
  const { curation, added, shown } = opened("abc");
  curation.decide("accept");
  curation.decide("unsure");
  curation.go(1);
  curation.undo();
  expect(shown()).toBe("b");
  expect(added.at(-1)).toMatchObject({ registrationId: "b", decision: "undo", undoes: { operationId: "op2" } });
  curation.undo();
  expect(shown()).toBe("a");
  const state = curation.store.get();
  expect(state.items.map((item) => decisionOf(state, item))).toEqual([null, null, null]);
  curation.undo();
  expect(added, "nothing is left to take back").toHaveLength(4);
});

test("who decides otherwise and takes it back has the first decision again", () => {
  const { curation, shown } = opened("a");
  curation.decide("accept");
  curation.go(-1);
  curation.decide("reject");
  curation.undo();
  expect(shown()).toBe("a");
  expect(decisionOf(curation.store.get(), registration("a"))).toBe("accept");
});

test("a decision of an earlier visit can be taken back once", () => {
  const { log, added } = aLog();
  const curation = openCuration(log, CHOICE);
  curation.append([registration("a", { my_decision: "accept", my_decision_id: "d7" })], false);
  curation.undo();
  curation.undo();
  expect(added).toMatchObject([{ decision: "undo", undoes: { decisionId: "d7" } }]);
});

test("what waits from before a reload stands already", () => {
  const { curation } = opened("ab", [
    { registrationId: "a", decision: "accept" },
    { registrationId: "b", decision: "reject" },
    { registrationId: "b", decision: "undo" },
  ]);
  const state = curation.store.get();
  expect(state.items.map((item) => decisionOf(state, item))).toEqual(["accept", null]);
});

test("the end of the queue is one beyond the last, and nothing can be decided there", () => {
  const { curation, added, shown } = opened("a");
  curation.decide("accept");
  expect(shown()).toBeNull();
  curation.decide("accept");
  curation.go(1);
  expect(added).toHaveLength(1);
  curation.append([registration("b"), registration("a")], false);
  expect(shown(), "what was loaded twice is there once").toBe("b");
});

test("what comes next is wanted first, then what was before", () => {
  const { curation } = opened("abcdefghij");
  curation.go(3);
  expect(soonShown(curation.store.get(), 3, 2).map((item) => item.id)).toEqual(["d", "e", "f", "g", "c", "b"]);
});
