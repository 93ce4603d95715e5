import { afterEach, expect, test, vi } from "vitest";
import type { KeptPoint } from "../model/pose";
import { createJournal, findWaiting, type Journal, type PendingSave } from "./journal";
import { createSaveQueue, type Outcome } from "./saveQueue";

afterEach(() => void vi.useRealTimers());

class MemoryStorage implements Storage {
  private readonly items = new Map<string, string>();
  get length(): number {
    return this.items.size;
  }
  clear = () => this.items.clear();
  getItem = (name: string) => this.items.get(name) ?? null;
  key = (index: number) => [...this.items.keys()][index] ?? null;
  removeItem = (name: string) => void this.items.delete(name);
  setItem = (name: string, value: string) => void this.items.set(name, value);
}

/** A server with revisions and idempotent operations, as the real one promises; `answer` may break the way back. */
function aServer() {
  const stored = new Map<string, { points: KeptPoint[] | null; revision: number }>();
  const known = new Map<string, number>();
  const log: PendingSave[] = [];
  return {
    stored,
    log,
    isDown: false,
    losesAnswer: false,
    send(key: string, save: PendingSave): Promise<Outcome> {
      return Promise.resolve(this.answer(key, save));
    },
    answer(key: string, save: PendingSave): Outcome {
      if (this.isDown) return { kind: "unreachable" };
      log.push(save);
      const done = known.get(save.operationId);
      const now = stored.get(key);
      if (done === undefined) {
        if ((now?.revision ?? null) !== save.base) {
          return { kind: "conflict", theirs: { points: now?.points ?? null, revision: now?.revision ?? null } };
        }
        const revision = (now?.revision ?? 0) + 1;
        stored.set(key, { points: save.points, revision });
        known.set(save.operationId, revision);
      }
      if (this.losesAnswer) return { kind: "unreachable" };
      return { kind: "saved", revision: known.get(save.operationId) ?? null };
    },
  };
}

const points = (x: number): KeptPoint[] => [[x, x, 2]];
const settled = () => new Promise((resolve) => setTimeout(resolve, 5));
const KEY = "0|right|cam0";

test("gestures made while one is on its way become one more save, based on its revision", async () => {
  const server = aServer();
  const queue = createSaveQueue((key, save) => server.send(key, save), createJournal(new MemoryStorage(), "anna", "r"));
  queue.put(KEY, points(1));
  queue.put(KEY, points(2));
  queue.put(KEY, points(3));
  await settled();
  expect(server.log.map((save) => [save.points?.[0]?.[0], save.base])).toEqual([[1, null], [3, 1]]);
  expect(queue.status().waiting).toBe(0);
});

test("what was not acknowledged survives a reload and is sent once", async () => {
  const server = aServer();
  const storage = new MemoryStorage();
  server.isDown = true;
  const first = createSaveQueue((key, save) => server.send(key, save), createJournal(storage, "anna", "r"));
  first.put(KEY, points(7));
  await settled();
  expect(first.status()).toMatchObject({ waiting: 1, isOffline: true });
  first.stop();

  server.isDown = false;
  const second = createSaveQueue((key, save) => server.send(key, save), createJournal(storage, "anna", "r"));
  expect(second.waiting().get(KEY)).toEqual(points(7));
  second.learn(new Map());
  await settled();
  expect(server.stored.get(KEY)).toEqual({ points: points(7), revision: 1 });
  expect(createJournal(storage, "anna", "r").load().size).toBe(0);
});

test("a save whose answer was lost is not taken for a conflict", async () => {
  vi.useFakeTimers();
  const server = aServer();
  server.losesAnswer = true;
  const queue = createSaveQueue((key, save) => server.send(key, save), createJournal(new MemoryStorage(), "anna", "r"));
  queue.put(KEY, points(1));
  await vi.advanceTimersByTimeAsync(10);
  queue.put(KEY, points(2));
  server.losesAnswer = false;
  await vi.advanceTimersByTimeAsync(2000);
  expect(queue.status().conflicts.size).toBe(0);
  expect(queue.status().waiting).toBe(0);
  expect(server.stored.get(KEY)?.points).toEqual(points(2));
});

test("another person's change is never overwritten before somebody chose", async () => {
  const server = aServer();
  server.stored.set(KEY, { points: points(100), revision: 4 });
  const queue = createSaveQueue((key, save) => server.send(key, save), createJournal(new MemoryStorage(), "anna", "r"));
  queue.learn(new Map([[KEY, 3]]));
  queue.put(KEY, points(5));
  await settled();
  expect(queue.status().conflicts.get(KEY)).toEqual({ points: points(100), revision: 4 });
  queue.put(KEY, points(6));
  await settled();
  expect(server.stored.get(KEY)?.points).toEqual(points(100));
  queue.settle(KEY, points(6));
  await settled();
  expect(server.stored.get(KEY)).toEqual({ points: points(6), revision: 5 });
});

test("taking theirs drops what waits and goes on from their revision", async () => {
  const server = aServer();
  server.stored.set(KEY, { points: points(100), revision: 4 });
  const queue = createSaveQueue((key, save) => server.send(key, save), createJournal(new MemoryStorage(), "anna", "r"));
  queue.put(KEY, points(5));
  await settled();
  queue.settle(KEY, "theirs");
  expect(queue.status()).toMatchObject({ waiting: 0 });
  queue.put(KEY, points(8));
  await settled();
  expect(server.stored.get(KEY)).toEqual({ points: points(8), revision: 5 });
});

test("hands and frames do not wait for each other", async () => {
  const held: string[] = [];
  const queue = createSaveQueue(
    (key) => (held.push(key), key === KEY ? new Promise(() => undefined) : Promise.resolve({ kind: "saved", revision: 1 })),
    createJournal(new MemoryStorage(), "anna", "r"),
  );
  queue.put(KEY, points(1));
  queue.put("1|right|cam0", points(2));
  await settled();
  expect(held).toEqual([KEY, "1|right|cam0"]);
  expect(queue.status()).toMatchObject({ waiting: 1, isSending: true });
});

test("a refused save stays, says why, and can be discarded", async () => {
  const queue = createSaveQueue(
    () => Promise.resolve({ kind: "refused", reason: "21 points are needed." }),
    createJournal(new MemoryStorage(), "anna", "r"),
  );
  queue.put(KEY, points(1));
  await settled();
  expect(queue.status().refusals.get(KEY)).toBe("21 points are needed.");
  queue.discard(KEY);
  expect(queue.status()).toMatchObject({ waiting: 0 });
});

test("a full browser storage is reported and the save still goes out", async () => {
  const server = aServer();
  const full: Journal = { load: () => new Map(), keep: (_, saves) => saves.length === 0 };
  const queue = createSaveQueue((key, save) => server.send(key, save), full);
  queue.put(KEY, points(1));
  expect(queue.status().isKept).toBe(false);
  await settled();
  expect(server.stored.get(KEY)?.points).toEqual(points(1));
  expect(queue.status().isKept).toBe(true);
});

test("work made after the login ended is held, kept, and sent once the person is back", async () => {
  const server = aServer();
  const storage = new MemoryStorage();
  let isOut = true;
  let asked = 0;
  const send = (key: string, save: PendingSave): Promise<Outcome> => {
    asked += 1;
    return isOut ? Promise.resolve({ kind: "held" }) : server.send(key, save);
  };
  const queue = createSaveQueue(send, createJournal(storage, "anna", "r"));
  queue.put(KEY, points(1));
  await settled();
  queue.put(KEY, points(2));
  queue.put("1|left|cam0", points(3));
  await settled();
  expect(queue.status()).toMatchObject({ isHeld: true, waiting: 2, isOffline: false });
  expect(queue.status().refusals.size).toBe(0);
  expect(asked, "nobody knocks again before the login").toBe(1);
  expect(createJournal(storage, "anna", "r").load().size).toBe(2);
  isOut = false;
  queue.flush();
  await settled();
  expect(queue.status()).toMatchObject({ isHeld: false, waiting: 0 });
  expect(server.stored.get(KEY)?.points).toEqual(points(2));
  expect(server.stored.get("1|left|cam0")?.points).toEqual(points(3));
});

test("each person has a journal of their own", () => {
  const storage = new MemoryStorage();
  createJournal(storage, "anna", "r").keep(KEY, [{ operationId: "1", points: points(1), base: null }]);
  createJournal(storage, "anna", "s").keep(KEY, [{ operationId: "2", points: points(1), base: null }]);
  expect(createJournal(storage, "ben", "r").load().size).toBe(0);
  expect(findWaiting(storage, "ben")).toEqual([]);
  expect(findWaiting(storage, "anna").sort()).toEqual(["r", "s"]);
});

test("a gesture made while the server's first answer after a pause is on its way is sent, too", async () => {
  vi.useFakeTimers();
  const answers: ((outcome: Outcome) => void)[] = [];
  const queue = createSaveQueue(() => new Promise((resolve) => answers.push(resolve)), createJournal(new MemoryStorage(), "anna", "r"));
  queue.put(KEY, points(1));
  answers[0]?.({ kind: "unreachable" });
  await vi.advanceTimersByTimeAsync(1500);
  expect(answers, "tried again").toHaveLength(2);
  queue.put("1|right|cam0", points(2));
  answers[1]?.({ kind: "saved", revision: 1 });
  await vi.advanceTimersByTimeAsync(10);
  answers[2]?.({ kind: "saved", revision: 1 });
  await vi.advanceTimersByTimeAsync(10);
  expect(queue.status()).toMatchObject({ waiting: 0, isOffline: false });
});
