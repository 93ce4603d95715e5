import { expect, test } from "vitest";
import { countTaken, cutOf, isInside, readStroke, simplify, smallerSide, takenBy, takenByAny, type Point } from "./crop";

/** Looking along -z, x and y as they are. */
const FLAT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
/** An eye at the origin that looks along -z. */
const EYE = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 0];
const circle = (radius: number, count = 40): Point[] =>
  Array.from({ length: count }, (_, at) => [radius * Math.cos((2 * Math.PI * at) / count), radius * Math.sin((2 * Math.PI * at) / count)]);
const grid = Float32Array.from(Array.from({ length: 21 * 21 }, (_, at) => [(at % 21) / 10 - 1, Math.floor(at / 21) / 10 - 1, 0]).flat());

test("a closed stroke takes exactly what it encloses, at every depth", () => {
  const stroke = readStroke(circle(0.5, 400));
  expect(stroke?.kind).toBe("lasso");
  const taken = takenBy(cutOf(stroke!.polygons[0]!, FLAT), grid);
  taken.forEach((one, at) => {
    const radius = Math.hypot(grid[3 * at]!, grid[3 * at + 1]!);
    if (Math.abs(radius - 0.5) > 0.01) expect(one).toBe(radius < 0.5 ? 1 : 0);
  });
  const deep = Float32Array.from([0.4, 0, -1, 0.4, 0, -2, 0.4, 0, -0.5, 0.4, 0, 3]);
  expect([...takenBy(cutOf(stroke!.polygons[0]!, EYE), deep)], "seen at 0.4, 0.2, 0.8, and behind the eye").toEqual([1, 1, 0, 0]);
});

test("an open stroke cuts right across the screen, and its two sides share every point out", () => {
  const stroke = readStroke([[-0.3, -0.55], [0, -0.52], [0.3, -0.55]])!;
  expect(stroke.kind).toBe("line");
  const [above, below] = stroke.polygons.map((polygon) => takenBy(cutOf(polygon, FLAT), grid)) as [Uint8Array, Uint8Array];
  expect(countTaken(above) + countTaken(below)).toBe(21 * 21);
  expect(countTaken(above)).toBe(21 * 16);
  expect(countTaken(below)).toBe(21 * 5);
});

test("the smaller side goes first, whichever way the stroke was drawn", () => {
  const line: Point[] = [[-0.5, -0.61], [0.5, -0.61]];
  for (const drawn of [line, [...line].reverse()]) {
    const stroke = readStroke(drawn)!;
    const side = smallerSide(stroke, FLAT, grid);
    expect(isInside(stroke.polygons[side]!, 0, -0.9)).toBe(true);
    expect(isInside(stroke.polygons[side]!, 0, 0.5)).toBe(false);
  }
});

test("a slip of the hand cuts nothing", () => {
  expect(readStroke([])).toBeNull();
  expect(readStroke([[0, 0]])).toBeNull();
  expect(readStroke([[0, 0], [0.01, 0.01]])).toBeNull();
});

test("a thinned stroke stays within its tolerance", () => {
  const wavy: Point[] = Array.from({ length: 500 }, (_, at) => [at / 250 - 1, 0.2 * Math.sin(at / 40)]);
  const thin = simplify(wavy, 0.003);
  expect(thin.length).toBeLessThan(60);
  for (const [x, y] of wavy) {
    const next = thin.findIndex((point) => point[0] >= x);
    const [a, b] = [thin[Math.max(0, next - 1)]!, thin[next]!];
    const at = b[0] === a[0] ? 0 : (x - a[0]) / (b[0] - a[0]);
    expect(Math.abs(a[1] + at * (b[1] - a[1]) - y)).toBeLessThan(0.003 * Math.hypot(1, 1.25));
  }
});

test("several strokes add up", () => {
  const cut = (x: number) => cutOf(circle(0.2).map(([a, b]): Point => [a + x, b]), FLAT);
  expect(countTaken(takenByAny([cut(0.5), cut(-0.5)], grid))).toBe(countTaken(takenBy(cut(0.5), grid)) + countTaken(takenBy(cut(-0.5), grid)));
  expect(countTaken(takenByAny([], grid))).toBe(0);
});

test("a plane takes what lies beyond it, and an outer cut what an inner one leaves", () => {
  const beyond = takenBy({ kind: "plane", normal: [0, 1, 0], offset: 0.55 }, grid);
  expect(countTaken(beyond)).toBe(21 * 5);
  const inner = cutOf(circle(0.33), FLAT);
  const [inside, outside] = [takenBy(inner, grid), takenBy({ ...inner, removes: "outside" }, grid)];
  expect(inside.every((one, at) => one + outside[at]! === 1)).toBe(true);
});
