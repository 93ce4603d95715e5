/** Calibrated cameras and boards as lines: positions in the world, m, OpenCV's axes (x right, y down, z forward). */

export interface Placed {
  readonly id: string;
  readonly width: number;
  readonly height: number;
  readonly K: readonly (readonly number[])[];
  readonly T_world_camera: readonly (readonly number[])[];
  readonly color: string;
}

export type Point = readonly [number, number, number];

const at = (T: readonly (readonly number[])[], row: number, column: number): number => T[row]?.[column] ?? 0;

const move = (T: readonly (readonly number[])[], [x, y, z]: Point): Point => {
  const value = (row: number): number => at(T, row, 0) * x + at(T, row, 1) * y + at(T, row, 2) * z + at(T, row, 3);
  return [value(0), value(1), value(2)];
};

export const centreOf = (T: readonly (readonly number[])[]): Point => move(T, [0, 0, 0]);

/** Ends of lines, two by two: the rays through the corners of the picture, its border `depth` m away, and a mark at its upper side. */
export function drawCamera({ width, height, K, T_world_camera: T }: Placed, depth: number): Point[] {
  const ray = (u: number, v: number): Point => {
    const y = (v - at(K, 1, 2)) / at(K, 1, 1);
    return move(T, [((u - at(K, 0, 2) - at(K, 0, 1) * y) / at(K, 0, 0)) * depth, y * depth, depth]);
  };
  const corners = [ray(-0.5, -0.5), ray(width - 0.5, -0.5), ray(width - 0.5, height - 0.5), ray(-0.5, height - 0.5)];
  const centre = centreOf(T);
  const [left, right] = [ray(0.35 * width, -0.06 * height), ray(0.65 * width, -0.06 * height)];
  const up = ray(0.5 * width, -0.3 * height);
  const border = corners.flatMap((corner, place) => [corner, corners[(place + 1) % 4] ?? corner]);
  return [...corners.flatMap((corner) => [centre, corner]), ...border, left, up, up, right, right, left];
}

/** The border of a board of this size, m: ends of lines, two by two. */
export function drawBoard(T: readonly (readonly number[])[], width: number, height: number): Point[] {
  const corners = ([[0, 0, 0], [width, 0, 0], [width, height, 0], [0, height, 0]] as const).map((corner) => move(T, corner));
  return corners.flatMap((corner, place) => [corner, corners[(place + 1) % 4] ?? corner]);
}

/** The middle of points, and how far the farthest is from it, m. */
export function findBall(points: readonly Point[]): { middle: Point; radius: number } {
  const reach = [0, 1, 2].map((axis) => {
    const values = points.map((point) => point[axis] ?? 0);
    return [Math.min(...values), Math.max(...values)] as const;
  });
  const middle = reach.map(([low, high]) => (low + high) / 2) as unknown as Point;
  const radius = Math.max(...points.map((point) => Math.hypot(...point.map((value, axis) => value - (middle[axis] ?? 0)))));
  return { middle, radius: Math.max(radius, 0.05) };
}
