import { afterEach, expect, test, vi } from "vitest";
import { ApiError } from "../../api/client";
import type { HandGeometry } from "./geometry";
import { createShelf } from "./shelf";
import type { Staged } from "./staged";

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 2));

function aStudio() {
  const released: string[] = [];
  const asked: string[] = [];
  const aborted: string[] = [];
  const answers = new Map<string, (failure?: Error) => void>();
  const load = (id: string, signal: AbortSignal): Promise<HandGeometry> =>
    new Promise((resolve, reject) => {
      asked.push(id);
      signal.addEventListener("abort", () => (aborted.push(id), reject(new Error("aborted"))));
      answers.set(id, (failure) => (failure ? reject(failure) : resolve({ name: id } as unknown as HandGeometry)));
    });
  const stage = { prepare: (geometry: HandGeometry) => ({ geometry, release: () => released.push((geometry as unknown as { name: string }).name) }) as unknown as Staged };
  return { released, asked, aborted, load, stage, answer: (id: string, failure?: Error) => (answers.get(id)?.(failure), settled()) };
}

const atOnce = (act: () => void): void => act();

test("the most urgent comes first, and the next ones follow by themselves, two at a time", async () => {
  const studio = aStudio();
  const shelf = createShelf(studio.stage, studio.load, atOnce);
  shelf.want(["a", "b", "c", "d"]);
  expect(studio.asked).toEqual(["a", "b"]);
  await studio.answer("a");
  expect(shelf.get("a")).not.toBeNull();
  expect(studio.asked).toEqual(["a", "b", "c"]);
  await studio.answer("b");
  await studio.answer("c");
  expect(studio.asked).toEqual(["a", "b", "c", "d"]);
});

test("what is not wanted any more is put away and leaves the card; what is still wanted is not asked for again", async () => {
  const studio = aStudio();
  const shelf = createShelf(studio.stage, studio.load, atOnce);
  shelf.want(["a", "b"]);
  await studio.answer("a");
  shelf.want(["b", "c"]);
  expect(studio.released).toEqual(["a"]);
  expect(shelf.get("a")).toBeNull();
  expect(studio.asked).toEqual(["a", "b", "c"]);
  shelf.want(["c"]);
  expect(studio.aborted, "on its way, and called off").toEqual(["b"]);
});

test("a failure is kept with its reason, does not stop the others, and can be tried again", async () => {
  const studio = aStudio();
  const told: string[] = [];
  const shelf = createShelf(studio.stage, studio.load, atOnce);
  shelf.watch((id) => told.push(id));
  shelf.want(["a", "b", "c"]);
  await studio.answer("a", new Error("gone"));
  expect(shelf.failureOf("a")?.message).toBe("gone");
  await studio.answer("b");
  await studio.answer("c");
  expect(told).toEqual(["a", "b", "c"]);
  shelf.retry("a");
  expect(shelf.failureOf("a")).toBeNull();
  await studio.answer("a");
  expect(shelf.get("a")).not.toBeNull();
});

afterEach(() => void vi.useRealTimers());

test("cut off, a hand is asked for again later and later, those behind it wait, and all come by themselves once the network is back", async () => {
  vi.useFakeTimers();
  const asked: string[] = [];
  let isCutOff = true;
  const load = (id: string): Promise<HandGeometry> => {
    asked.push(id);
    return isCutOff ? Promise.reject(new ApiError(0, "Unreachable", "No answer.")) : Promise.resolve({ name: id } as unknown as HandGeometry);
  };
  const shelf = createShelf(aStudio().stage, load, atOnce);
  shelf.want(["a", "b", "c", "d"]);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(shelf.failureOf("a")?.message).toBe("No answer.");
  expect(asked.length, "two hands, at once and after 1, 2, 4, 8, 10, ... s").toBeLessThanOrEqual(18);
  expect(new Set(asked)).toEqual(new Set(["a", "b"]));
  isCutOff = false;
  await vi.advanceTimersByTimeAsync(20_000);
  expect(["a", "b", "c", "d"].map((id) => shelf.get(id) !== null && shelf.failureOf(id) === null)).toEqual([true, true, true, true]);
});

test("after the end nothing is brought to the card, and all of it is given back", async () => {
  const studio = aStudio();
  const shelf = createShelf(studio.stage, studio.load, atOnce);
  shelf.want(["a", "b"]);
  await studio.answer("a");
  shelf.stop();
  await studio.answer("b");
  expect(studio.released).toEqual(["a"]);
  expect(shelf.get("b")).toBeNull();
});
