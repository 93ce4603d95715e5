import { expect, test } from "vitest";
import { rotationOnto, turn, uprightByShape, type Quaternion } from "./upright";

const random = (seed: number) => () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
const cloud = (count: number, next: () => number): number[] => Array.from({ length: 3 * count }, next);
const turned = (q: Quaternion, points: number[]): number[] =>
  Array.from({ length: points.length / 3 }, (_, at) => turn(q, points.slice(3 * at, 3 * at + 3) as [number, number, number])).flat();

test("the rotation that a cloud was turned by comes back, whatever the shift", () => {
  const next = random(7);
  for (let time = 0; time < 20; time += 1) {
    const raw = [next(), next(), next(), next()];
    const q = raw.map((value) => value / Math.hypot(...raw)) as unknown as Quaternion;
    const points = cloud(40, next);
    const target = turned(q, points).map((value) => value + 3);
    const found = rotationOnto(points, target);
    turned(found, points).forEach((value, at) => expect(value + 3).toBeCloseTo(target[at]!, 9));
  }
});

test("a scan without a registration stands on its long axis, flat side to the viewer", () => {
  const next = random(3);
  const flat = Array.from({ length: 400 }, () => [0.02 * next(), 0.09 * next(), 0.2 * next()]).flat();
  const q = uprightByShape(flat);
  expect(Math.abs(turn(q, [0, 0, 1])[1])).toBeGreaterThan(0.98);
  expect(Math.abs(turn(q, [1, 0, 0])[2])).toBeGreaterThan(0.98);
  const [x, y] = [turn(q, [0, 1, 0]), turn(q, [0, 0, 1])];
  const cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
  const image = turn(q, [1, 0, 0]);
  cross.forEach((value, axis) => expect(value, "a mirror image would show a left hand as a right one").toBeCloseTo(image[axis]!, 9));
});
