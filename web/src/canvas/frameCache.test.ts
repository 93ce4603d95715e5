import { afterEach, expect, test, vi } from "vitest";
import { ApiError } from "../api/client";
import { aheadFor, createFrameCache, framesToLoad, travelOn, type Travel } from "./frameCache";

const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

test("prefetches in the direction of travel, and one frame behind", () => {
  expect(framesToLoad(10, 1, 100, 3)).toEqual([10, 11, 12, 13, 9]);
  expect(framesToLoad(10, -1, 100, 3)).toEqual([10, 9, 8, 7, 11]);
  expect(framesToLoad(99, 1, 100, 3)).toEqual([99, 98]);
});

test("loads each address once and forgets the one used longest ago", async () => {
  const loaded: string[] = [];
  const gone: string[] = [];
  const cache = createFrameCache((address) => (loaded.push(address), Promise.resolve(address)), {
    capacity: 3,
    weigh: () => 1,
    dispose: (picture) => gone.push(picture),
  });
  for (const wanted of [["a", "b"], ["a"], ["c"], ["d"]]) {
    cache.focus(wanted);
    await settled();
  }
  expect(loaded).toEqual(["a", "b", "c", "d"]);
  expect(gone).toEqual(["b"]);
  expect([cache.peek("a"), cache.peek("b")]).toEqual(["a", undefined]);
});

test("calls off what nobody wants any more", async () => {
  const aborted: string[] = [];
  const cache = createFrameCache<string>(
    (address, signal) => new Promise((_, reject) => signal.addEventListener("abort", () => (aborted.push(address), reject(new Error("off"))))),
    { capacity: 10, weigh: () => 1 },
  );
  cache.focus(["a", "b", "c", "d", "e"]);
  cache.focus(["e", "b"]);
  await settled();
  expect(aborted.sort()).toEqual(["a", "c", "d"]);
});

test("several panes look at once: nobody calls off another's picture, and everybody's first comes before a second", async () => {
  const loaded: string[] = [];
  const aborted: string[] = [];
  const finish: (() => void)[] = [];
  const cache = createFrameCache<string>(
    (address, signal) => {
      loaded.push(address);
      signal.addEventListener("abort", () => aborted.push(address));
      return new Promise((resolve) => finish.push(() => resolve(address)));
    },
    { capacity: 100, weigh: () => 1, parallel: 4 },
  );
  ["a", "b", "c"].forEach((pane) => cache.focus([`${pane}0`, `${pane}1`, `${pane}2`], pane));
  while (loaded.length < 9) {
    finish.splice(0).forEach((done) => done());
    await settled();
  }
  expect(["a0", "b0", "c0"].map(cache.peek)).toEqual(["a0", "b0", "c0"]);
  expect(loaded.indexOf("c0")).toBeLessThan(loaded.indexOf("b2"));
  expect(aborted).toEqual([]);
  cache.focus(["d0"], "a");
  cache.leave("a");
  expect(aborted).toEqual(["d0"]);
});

test("prefetching stops where it would push out what is wanted sooner", async () => {
  const loaded: string[] = [];
  const cache = createFrameCache((address) => (loaded.push(address), Promise.resolve(address)), { capacity: 4, weigh: () => 1, parallel: 4 });
  cache.focus(["a", "b", "c", "d", "e", "f", "g"]);
  for (let k = 0; k < 5; k += 1) await settled();
  expect(cache.peek("a")).toBe("a");
  expect(cache.peek("b")).toBe("b");
  expect(loaded.length).toBeLessThanOrEqual(7);
});

test("who keeps going gets a second of frames in stock, unless they are large; a jump starts anew", () => {
  let travel: Travel = { frame: 0, direction: 1, run: 0 };
  expect(aheadFor({ frame: 0, direction: 1, run: -1 }, 1e6)).toBe(4); // nobody knows which way yet
  expect(travelOn({ frame: 0, direction: 1, run: -1 }, 1).run).toBe(0);
  for (const frame of [1, 2, 3]) travel = travelOn(travel, frame);
  expect([travel.run, aheadFor(travel, 1e6), aheadFor(travel, 30e6)]).toEqual([3, 30, 5]);
  expect(travelOn(travel, 500)).toEqual({ frame: 500, direction: 1, run: 0 });
  expect(travelOn(travel, 2)).toEqual({ frame: 2, direction: -1, run: 0 });
  expect(travelOn(travel, 3)).toBe(travel);
});

test("who turns back gets the picture that was called off a moment ago", async () => {
  const cache = createFrameCache<string>(
    (address, signal) =>
      new Promise((resolve, reject) => {
        signal.addEventListener("abort", () => setTimeout(() => reject(new DOMException("", "AbortError"))));
        setTimeout(() => resolve(address), 5);
      }),
    { capacity: 10, weigh: () => 1 },
  );
  ["a", "b", "a"].forEach((address) => cache.focus([address]));
  await new Promise<void>((resolve) => cache.watch((address) => address === "a" && resolve()));
  expect(cache.peek("a")).toBe("a");
});

afterEach(() => void vi.useRealTimers());

/** A server that can be cut off, and what was asked of it; time is set by the test. */
function aServer() {
  vi.useFakeTimers();
  const server = { asked: [] as string[], failure: null as Error | null };
  const load = (address: string): Promise<string> => {
    server.asked.push(address);
    return server.failure ? Promise.reject(server.failure) : Promise.resolve(address);
  };
  return { server, cache: createFrameCache(load, { capacity: 100, weigh: () => 1 }) };
}

const offline = new ApiError(0, "Unreachable", "No answer.");
const window = ["a", "b", "c", "d", "e", "f", "g", "h"];

test("cut off, a picture is asked for again later and later, one request at a time, and nothing is fetched in advance", async () => {
  const { server, cache } = aServer();
  server.failure = offline;
  cache.focus(window);
  await vi.advanceTimersByTimeAsync(0);
  expect(server.asked.length, "as many as there are at once").toBeLessThanOrEqual(6);
  expect(cache.setbackOf("a")).toMatchObject({ error: offline, isForGood: false });
  server.asked.length = 0;
  await vi.advanceTimersByTimeAsync(60_000);
  expect(server.asked.every((address) => address === "a"), server.asked.join(" ")).toBe(true);
  expect(server.asked.length, "after 1, 2, 4, 8, 10, 10, 10, 10 s").toBe(8);
});

test("back again, everything comes by itself", async () => {
  const { server, cache } = aServer();
  const told: string[] = [];
  server.failure = offline;
  cache.watch((address) => told.push(address));
  cache.focus(window);
  await vi.advanceTimersByTimeAsync(5000);
  server.failure = null;
  await vi.advanceTimersByTimeAsync(20_000);
  expect(window.map(cache.peek)).toEqual(window);
  expect(cache.setbackOf("a")).toBeNull();
  expect(told).toContain("h");
});

test("a computer that says that its network is back is believed at once", async () => {
  const listeners = new EventTarget();
  vi.stubGlobal("addEventListener", listeners.addEventListener.bind(listeners));
  const { server, cache } = aServer();
  vi.unstubAllGlobals();
  server.failure = offline;
  cache.focus(["a"]);
  await vi.advanceTimersByTimeAsync(20_000);
  server.failure = null;
  listeners.dispatchEvent(new Event("online"));
  await vi.advanceTimersByTimeAsync(0);
  expect(cache.peek("a")).toBe("a");
});

test("what the server does not have is not asked for again until somebody comes to it anew, or asks", async () => {
  const { server, cache } = aServer();
  server.failure = new ApiError(404, "NotFound", "No such picture.");
  cache.focus(["a"]);
  await vi.advanceTimersByTimeAsync(60_000);
  cache.focus(["a", "b"]);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(server.asked).toEqual(["a", "b"]);
  expect(cache.setbackOf("a")).toMatchObject({ isForGood: true });
  cache.focus(["c", "a"]);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(server.asked.filter((address) => address === "a"), "behind another one it is not looked at").toEqual(["a"]);
  cache.focus(["a"]);
  await vi.advanceTimersByTimeAsync(60_000);
  server.failure = null;
  cache.retry("a");
  await vi.advanceTimersByTimeAsync(0);
  expect(server.asked.filter((address) => address === "a").length).toBe(3);
  expect(cache.peek("a")).toBe("a");
});
