import { expect, it } from "vitest";
import type { FrameRegistration } from "../api/movingScans";
import { beginAt, countFrames, endAt, movingRows, nextDoubt, sayStretch } from "./stretch";

const frame = (at: number, more: Partial<FrameRegistration> = {}): FrameRegistration => ({ frame: at, verdict: "good", reasons: [], mean_mm: 0.6, p95_mm: 2, guessed: [], decision: null, ...more });
const COLORS = { guessed: "violet", accepted: "teal", rejected: "red", chosen: "grey" };

it("a stretch that is begun behind its end, or ended before its beginning, is that frame alone", () => {
  const stretch = { first: 4, last: 9 };
  expect(beginAt(stretch, 6)).toEqual({ first: 6, last: 9 });
  expect(beginAt(stretch, 12)).toEqual({ first: 12, last: 12 });
  expect(endAt(stretch, 2)).toEqual({ first: 2, last: 2 });
  expect([countFrames(stretch), sayStretch(stretch), sayStretch({ first: 3, last: 3 })]).toEqual([6, "frames 4 to 9", "frame 3"]);
});

it("the rows say distances, guessed hands, decisions and what is chosen, at their frames", () => {
  const frames = [frame(0), frame(1, { mean_mm: 9, guessed: ["left"], decision: "reject" }), frame(3, { mean_mm: null, decision: "accept" })];
  const [distance, left, right, decision, chosen] = movingRows(frames, 4, { first: 1, last: 2 }, COLORS);
  expect([...(distance?.values as number[])].map((value) => Number(value.toFixed(2)))).toEqual([0.2, 1, 0, 0]);
  expect(left?.values).toEqual([0, 1, 0, 0]);
  expect(right?.values).toEqual([0, 0, 0, 0]);
  expect(decision?.values).toEqual([0, 0.5, 0, 1]);
  expect([1, 0.5].map((value) => (decision?.color as (value: number) => string)(value))).toEqual(["teal", "red"]);
  expect(chosen?.values).toEqual([0, 1, 1, 0]);
});

it("the next frame to look at is one that is not good or has a guessed hand", () => {
  const frames = [frame(0), frame(1, { verdict: "doubtful" }), frame(2), frame(5, { guessed: ["right"] }), frame(6)];
  expect([nextDoubt(frames, 0, 1), nextDoubt(frames, 1, 1), nextDoubt(frames, 5, 1), nextDoubt(frames, 6, -1), nextDoubt(frames, 1, -1)]).toEqual([1, 5, null, 5, null]);
});
