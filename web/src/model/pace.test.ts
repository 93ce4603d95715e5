import { expect, test } from "vitest";
import { paceOf } from "./pace";

test("the pace is that of the last decisions, and says how long the rest takes", () => {
  const times = Array.from({ length: 100 }, (_, at) => (at < 60 ? at * 10_000 : 600_000 + (at - 60) * 2000));
  expect(paceOf(times, 60)).toEqual({ perMinute: 30, secondsLeft: 120 });
});

test("a pause is not work", () => {
  expect(paceOf([0, 2000, 4000, 3_604_000, 3_606_000], 10).perMinute).toBe(30);
});

test("one decision makes no pace, nor does a clock that stands still or runs back", () => {
  for (const times of [[], [5], [5, 5], [9000, 5]]) expect(paceOf(times, 10)).toEqual({ perMinute: null, secondsLeft: null });
});
