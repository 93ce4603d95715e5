import { expect, test } from "vitest";
import { formatSize, formatUnit, isGuess, judgeSize, unitOf, writeUnits } from "./scanUnit";

const file = (name: string, guess: number | null, listed: number | null = null) => ({ file: name, guess, metres_per_unit: listed });

test("sizes are written in cm, and units by their names where they have one", () => {
  expect(formatSize([0.18, 0.0924, 0.061])).toBe("18.0 × 9.2 × 6.1 cm");
  expect(formatSize([1.8, 0.9, 0.5])).toBe("180 × 90 × 50 cm");
  expect(formatSize([0.0748, 0.0514, 0.0017])).toBe("7.5 × 5.1 × 0.17 cm");
  expect([formatUnit(0.0254), formatUnit(0.0285), formatUnit(null)]).toEqual(["inches", "1 unit = 28.5 mm", "never said"]);
});

test("a size is too small, a hand's, to be cropped, or too large", () => {
  expect([0.075, 0.08, 0.6, 0.61, 3, 3.1].map((length) => judgeSize(length).state)).toEqual(["bad", "good", "good", "crop", "crop", "bad"]);
});

test("a scans.json wins over what is said here, that over the guess, and only the guess is one", () => {
  const [listed, own, other] = [file("a", null, 0.5), file("b", 0.001), file("c", 0.001)];
  const answers = { all: null, own: { a: 0.01, b: 0.0285 } };
  expect([listed, own, other].map((one) => unitOf(one, answers))).toEqual([0.5, 0.0285, 0.001]);
  expect([listed, own, other].map((one) => isGuess(one, answers))).toEqual([false, false, true]);
  expect(isGuess(other, { all: 0.01, own: {} })).toBe(false);
  expect(isGuess(file("d", null), { all: null, own: {} })).toBe(false);
});

test("the unit of most files is said once, and that of the others by name", () => {
  const files = [file("a", 0.001), file("b", 0.001), file("c", null)];
  expect(writeUnits(files, { all: null, own: { c: 0.0285 } })).toEqual({ metres_per_unit: 0.001, units: { c: 0.0285 } });
  expect(writeUnits(files, { all: 0.01, own: {} })).toEqual({ metres_per_unit: 0.01 });
  expect(writeUnits([], { all: null, own: {} })).toEqual({});
});
