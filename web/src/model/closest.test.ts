import { expect, test } from "vitest";
import { closestOnMesh, closestOnTriangle } from "./closest";

type Vector = readonly [number, number, number];
const random = (seed: number) => () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
const far = (p: Vector, q: Vector): number => Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);

test("no point of the triangle is closer than the one found, wherever one looks from", () => {
  const next = random(11);
  const vector = (): Vector => [next(), next(), next()];
  for (let time = 0; time < 200; time += 1) {
    const [p, a, b, c] = [vector(), vector(), vector(), vector()];
    const found = far(p, closestOnTriangle(p, a, b, c));
    let least = Infinity;
    for (let i = 0; i <= 40; i += 1) {
      for (let j = 0; i + j <= 40; j += 1) {
        const [u, v] = [i / 40, j / 40];
        least = Math.min(least, far(p, [0, 1, 2].map((k) => a[k]! + u * (b[k]! - a[k]!) + v * (c[k]! - a[k]!)) as unknown as Vector));
      }
    }
    expect(found).toBeLessThanOrEqual(least + 1e-9);
    expect(found).toBeGreaterThan(least - 0.03);
  }
});

test("points over a flat sheet come straight down to it, those beside it to its edge", () => {
  const sheet = Float32Array.from([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
  const index = Uint32Array.from([0, 1, 2, 0, 2, 3]);
  const found = closestOnMesh(Float32Array.from([0.3, 0.4, 0.5, 1.5, 0.5, 0.2, -1, -1, 0]), sheet, index);
  [0.3, 0.4, 0, 1, 0.5, 0, 0, 0, 0].forEach((value, at) => expect(found[at]).toBeCloseTo(value, 6));
});

test("a triangle without area is still answered", () => {
  expect(closestOnTriangle([1, 1, 1], [0, 0, 0], [0, 0, 0], [0, 0, 0])).toEqual([0, 0, 0]);
});
