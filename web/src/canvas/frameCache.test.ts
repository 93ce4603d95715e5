import { expect, test } from "vitest";
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
  await cache.focus(["a", "b"]);
  await settled();
  await cache.focus(["a"]);
  await cache.focus(["c"]);
  await cache.focus(["d"]);
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
  cache.focus(["a", "b", "c", "d", "e"]).catch(() => undefined);
  cache.focus(["e", "b"]).catch(() => undefined);
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
  const firsts = ["a", "b", "c"].map((pane) => cache.focus([`${pane}0`, `${pane}1`, `${pane}2`], pane));
  while (loaded.length < 9) {
    finish.splice(0).forEach((done) => done());
    await settled();
  }
  expect(await Promise.all(firsts)).toEqual(["a0", "b0", "c0"]);
  expect(loaded.indexOf("c0")).toBeLessThan(loaded.indexOf("b2"));
  expect(aborted).toEqual([]);
  cache.focus(["d0"], "a").catch(() => undefined);
  cache.leave("a");
  expect(aborted).toEqual(["d0"]);
});

test("prefetching stops where it would push out what is wanted sooner", async () => {
  const loaded: string[] = [];
  const cache = createFrameCache((address) => (loaded.push(address), Promise.resolve(address)), { capacity: 4, weigh: () => 1, parallel: 4 });
  await cache.focus(["a", "b", "c", "d", "e", "f", "g"]);
  for (let k = 0; k < 5; k += 1) await settled();
  expect(cache.peek("a")).toBe("a");
  expect(cache.peek("b")).toBe("b");
  expect(loaded.length).toBeLessThanOrEqual(7);
});

test("who keeps going gets a second of frames in stock, unless they are large; a jump starts anew", () => {
  let travel: Travel = { frame: 0, direction: 1, run: 0 };
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
  cache.focus(["a"]).catch(() => undefined);
  cache.focus(["b"]).catch(() => undefined);
  expect(await cache.focus(["a"])).toBe("a");
});
