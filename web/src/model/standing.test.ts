import { expect, it } from "vitest";
import { standingUp } from "./standing";
import { turn } from "./upright";

/** A board 0.5 m broad, 1.7 m high and 0.2 m deep, turned about the up axis. */
function board(angle: number, isUp: "y" | "z", more: readonly (readonly [number, number, number])[] = []): number[] {
  const points: number[] = [];
  for (const [x, y, z] of [[0.25, 0, 0.1], [-0.25, 0, 0.1], [0.25, 1.7, -0.1], [-0.25, 1.7, -0.1], [0.25, 1.7, 0.1], [-0.25, 0, -0.1], ...more] as const) {
    const [across, deep] = [x * Math.cos(angle) - z * Math.sin(angle), x * Math.sin(angle) + z * Math.cos(angle)];
    points.push(...(isUp === "y" ? [across, y, deep] : [across, -deep, y]));
  }
  return points;
}

for (const isUp of ["y", "z"] as const) {
  for (const angle of [0, 0.5, 1.4, -2.1]) {
    it(`stands a person upright, broad side to the viewer, with ${isUp} up and turned by ${angle}`, () => {
      const points = board(angle, isUp);
      const quaternion = standingUp(points);
      const turned = Array.from({ length: points.length / 3 }, (_, at) => turn(quaternion, points.slice(3 * at, 3 * at + 3) as [number, number, number]));
      const extent = (axis: number): number => Math.max(...turned.map((point) => point[axis] as number)) - Math.min(...turned.map((point) => point[axis] as number));
      expect(extent(1)).toBeCloseTo(1.7, 6);
      expect(extent(0)).toBeGreaterThan(extent(2));
      expect(Math.hypot(...quaternion)).toBeCloseTo(1, 9);
    });

    it(`looks a person in the face: toes point to the viewer, with ${isUp} up and turned by ${angle}`, () => {
      const [toe, shin] = [[0, 0.02, 0.18], [0, 0.3, 0]] as const;
      const points = board(angle, isUp, [toe, toe, shin]);
      const quaternion = standingUp(points);
      const places = board(angle, isUp, [toe, shin]).slice(-6);
      const depth = (at: number): number => turn(quaternion, places.slice(at, at + 3) as [number, number, number])[2];
      expect(depth(0) - depth(3)).toBeGreaterThan(0.1);
    });
  }
}
