/** Cutting a scan with one stroke on the screen: a closed one takes what it encloses, an open one what lies beyond it. */

export type Point = readonly [number, number];

/** Clip coordinates of a scan's point: 4x4, row by row, scan frame (m) to clip space. */
export type Projection = readonly number[];

/** What one stroke takes: every point whose picture lies inside of the corners, or outside. As the API has it. */
export interface PolygonCut {
  readonly kind: "polygon";
  /** -1..1, x right, y up. */
  readonly corners: readonly Point[];
  readonly view: Projection;
  readonly removes: "inside" | "outside";
}

/** Every point p with normal . p > offset, scan frame, m. */
export interface PlaneCut {
  readonly kind: "plane";
  readonly normal: readonly [number, number, number];
  readonly offset: number;
}

export type Cut = PolygonCut | PlaneCut;

export const cutOf = (corners: readonly Point[], view: Projection): PolygonCut => ({ kind: "polygon", corners, view, removes: "inside" });

export interface Stroke {
  readonly kind: "lasso" | "line";
  /** For a line the second polygon is the other side of it. */
  readonly polygons: readonly (readonly Point[])[];
}

/** Beyond every corner of the screen. */
const FAR = 4;

const distance = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1]);
const lengthOf = (points: readonly Point[]): number => points.slice(1).reduce((sum, point, at) => sum + distance(point, points[at] as Point), 0);

/** Fewer points that lie within `tolerance` of the drawn ones [Douglas and Peucker 1973]. */
export function simplify(points: readonly Point[], tolerance: number): Point[] {
  const first = points[0];
  const last = points.at(-1);
  if (!first || !last || points.length < 3) return [...points];
  const along = distance(first, last);
  let farthest = 0;
  let place = 0;
  points.forEach((point, at) => {
    const off =
      along === 0
        ? distance(point, first)
        : Math.abs((last[0] - first[0]) * (first[1] - point[1]) - (first[0] - point[0]) * (last[1] - first[1])) / along;
    if (off > farthest) [farthest, place] = [off, at];
  });
  if (farthest <= tolerance) return [first, last];
  return [...simplify(points.slice(0, place + 1), tolerance).slice(0, -1), ...simplify(points.slice(place), tolerance)];
}

/** What a drawn stroke means; null when it is too short to mean anything. Points as in `Cut`. */
export function readStroke(drawn: readonly Point[], tolerance = 0.003): Stroke | null {
  const points = simplify(drawn, tolerance);
  const first = points[0];
  const last = points.at(-1);
  const length = lengthOf(drawn);
  if (!first || !last || length < 0.04) return null;
  const gap = distance(first, last);
  if (gap < 0.25 * length) return points.length < 3 ? null : { kind: "lasso", polygons: [points] };
  const ahead: Point = [(last[0] - first[0]) / gap, (last[1] - first[1]) / gap];
  const beyond = (from: Point, along: number, aside: number): Point => [
    from[0] + along * ahead[0] - aside * ahead[1],
    from[1] + along * ahead[1] + aside * ahead[0],
  ];
  const line = [beyond(first, -FAR, 0), ...points, beyond(last, FAR, 0)];
  return { kind: "line", polygons: [1, -1].map((aside) => [...line, beyond(last, FAR, 2 * FAR * aside), beyond(first, -FAR, 2 * FAR * aside)]) };
}

/** By the even-odd rule. */
export function isInside(polygon: readonly Point[], x: number, y: number): boolean {
  let inside = false;
  for (let at = 0, before = polygon.length - 1; at < polygon.length; before = at, at += 1) {
    const [ax, ay] = polygon[at] as Point;
    const [bx, by] = polygon[before] as Point;
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

/** 1 for every point (three numbers each, scan frame) that the cut takes. What is behind the eye stays. */
export function takenBy(cut: Cut, positions: Float32Array): Uint8Array {
  const taken = new Uint8Array(positions.length / 3);
  const at = (place: number): number => positions[place] as number;
  if (cut.kind === "plane") {
    const [a, b, c] = cut.normal;
    return taken.map((_, point) => (a * at(3 * point) + b * at(3 * point + 1) + c * at(3 * point + 2) > cut.offset ? 1 : 0));
  }
  const m = cut.view as number[];
  const wanted = cut.removes === "inside";
  for (let point = 0; point < taken.length; point += 1) {
    const [x, y, z] = [at(3 * point), at(3 * point + 1), at(3 * point + 2)];
    const w = m[12]! * x + m[13]! * y + m[14]! * z + m[15]!;
    if (w <= 0) continue;
    const [u, v] = [(m[0]! * x + m[1]! * y + m[2]! * z + m[3]!) / w, (m[4]! * x + m[5]! * y + m[6]! * z + m[7]!) / w];
    if (isInside(cut.corners, u, v) === wanted) taken[point] = 1;
  }
  return taken;
}

/** Everything that some of the cuts take. */
export function takenByAny(cuts: readonly Cut[], positions: Float32Array): Uint8Array {
  const all = new Uint8Array(positions.length / 3);
  for (const cut of cuts) takenBy(cut, positions).forEach((one, at) => one && (all[at] = 1));
  return all;
}

export const countTaken = (taken: Uint8Array): number => taken.reduce((sum, one) => sum + one, 0);

/** Of the sides of a stroke the one that takes fewer points: the other is one key away. */
export function smallerSide(stroke: Stroke, projection: Projection, positions: Float32Array): number {
  const counts = stroke.polygons.map((corners) => countTaken(takenBy(cutOf(corners, projection), positions)));
  return counts.indexOf(Math.min(...counts));
}
