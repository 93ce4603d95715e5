/** Where a point that one camera sees at a pixel can be in the image of another. OpenCV's camera, distortion and all. */

import type { Camera } from "../api/types";
import type { Point } from "../canvas/view";

type Vector = readonly [number, number, number];

/** A line bends with the lens: points along it, one after the other, px. */
export type Curve = readonly Point[];

/** More than enough for a line to look smooth, and to be within a twentieth of a pixel of the true one. */
const SAMPLES = 96;

/** Nothing is looked at from nearer, m. */
const NEAREST = 0.05;

const at = (list: readonly number[], index: number): number => list[index] ?? 0;
const row = (camera: Camera, index: number): readonly number[] => camera.K[index] ?? [];

/** Rotation of a tilted sensor (OpenCV's τx, τy) as the 3x3 homography that it applies. */
function tiltOf(tauX: number, tauY: number): readonly number[] {
  const [cx, sx, cy, sy] = [Math.cos(tauX), Math.sin(tauX), Math.cos(tauY), Math.sin(tauY)];
  // R = Ry(τy) Rx(τx), as in OpenCV's computeTiltProjectionMatrix.
  const [r00, r01, r02] = [cy, sy * sx, -sy * cx];
  const [r10, r11, r12] = [0, cx, sx];
  const [r20, r21, r22] = [sy, -cy * sx, cy * cx];
  return [r22 * r00 - r02 * r20, r22 * r01 - r02 * r21, 0, r22 * r10 - r12 * r20, r22 * r11 - r12 * r21, 0, r20, r21, r22];
}

/** Pixel of the ray (x, y, 1) of a camera. */
export function distort(camera: Camera, x: number, y: number): Point {
  const d = camera.distortion;
  const r2 = x * x + y * y;
  let [u, v] = [x, y];
  if (d.length > 0) {
    const r4 = r2 * r2;
    const r6 = r4 * r2;
    const radial = (1 + at(d, 0) * r2 + at(d, 1) * r4 + at(d, 4) * r6) / (1 + at(d, 5) * r2 + at(d, 6) * r4 + at(d, 7) * r6);
    u = x * radial + 2 * at(d, 2) * x * y + at(d, 3) * (r2 + 2 * x * x) + at(d, 8) * r2 + at(d, 9) * r4;
    v = y * radial + at(d, 2) * (r2 + 2 * y * y) + 2 * at(d, 3) * x * y + at(d, 10) * r2 + at(d, 11) * r4;
    if (d.length > 12) {
      const t = tiltOf(at(d, 12), at(d, 13));
      const w = at(t, 6) * u + at(t, 7) * v + at(t, 8);
      [u, v] = [(at(t, 0) * u + at(t, 1) * v) / w, (at(t, 3) * u + at(t, 4) * v) / w];
    }
  }
  return { x: at(row(camera, 0), 0) * u + at(row(camera, 0), 2), y: at(row(camera, 1), 1) * v + at(row(camera, 1), 2) };
}

/** The ray (x, y, 1) of a camera that meets a pixel, or null where the lens lets nothing be seen. */
export function undistort(camera: Camera, pixel: Point): Point | null {
  let x = (pixel.x - at(row(camera, 0), 2)) / at(row(camera, 0), 0);
  let y = (pixel.y - at(row(camera, 1), 2)) / at(row(camera, 1), 1);
  if (camera.distortion.length === 0) return { x, y };
  const [targetX, targetY] = [x, y];
  const h = 1e-7;
  // First towards it a little at a time: far from the centre Newton's method alone may leap over the fold.
  for (let step = 1; step <= 4; step += 1) {
    const share = step / 4;
    const goal = {
      x: at(row(camera, 0), 2) + at(row(camera, 0), 0) * targetX * share,
      y: at(row(camera, 1), 2) + at(row(camera, 1), 1) * targetY * share,
    };
    if (step === 1) [x, y] = [targetX * share, targetY * share];
    for (let k = 0; k < 6; k += 1) {
      const here = distort(camera, x, y);
      const right = distort(camera, x + h, y);
      const below = distort(camera, x, y + h);
      const [a, b] = [(right.x - here.x) / h, (below.x - here.x) / h];
      const [c, d] = [(right.y - here.y) / h, (below.y - here.y) / h];
      const det = a * d - b * c;
      if (!(det > 0)) return null;
      const [ex, ey] = [goal.x - here.x, goal.y - here.y];
      x += (d * ex - b * ey) / det;
      y += (a * ey - c * ex) / det;
    }
  }
  const reached = distort(camera, x, y);
  return Math.hypot(reached.x - pixel.x, reached.y - pixel.y) < 1e-3 ? { x, y } : null;
}

const entry = (camera: Camera, i: number, j: number): number => at(camera.T_world_camera[i] ?? [], j);

/** Direction in the world of a direction of the camera. */
const turn = (camera: Camera, [x, y, z]: Vector): Vector => [
  entry(camera, 0, 0) * x + entry(camera, 0, 1) * y + entry(camera, 0, 2) * z,
  entry(camera, 1, 0) * x + entry(camera, 1, 1) * y + entry(camera, 1, 2) * z,
  entry(camera, 2, 0) * x + entry(camera, 2, 1) * y + entry(camera, 2, 2) * z,
];

/** Direction of the camera of a direction in the world. */
const turnBack = (camera: Camera, [x, y, z]: Vector): Vector => [
  entry(camera, 0, 0) * x + entry(camera, 1, 0) * y + entry(camera, 2, 0) * z,
  entry(camera, 0, 1) * x + entry(camera, 1, 1) * y + entry(camera, 2, 1) * z,
  entry(camera, 0, 2) * x + entry(camera, 1, 2) * y + entry(camera, 2, 2) * z,
];

const centre = (camera: Camera): Vector => [entry(camera, 0, 3), entry(camera, 1, 3), entry(camera, 2, 3)];

interface Box {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

const boxes = new WeakMap<Camera, Box | null>();

/** What a camera sees, in the plane at distance 1: the box about its undistorted border. */
function fieldOf(camera: Camera): Box | null {
  const known = boxes.get(camera);
  if (known !== undefined) return known;
  const rays: Point[] = [];
  const { width, height } = camera;
  for (let k = 0; k <= 16; k += 1) {
    const [x, y] = [-0.5 + (width * k) / 16, -0.5 + (height * k) / 16];
    for (const pixel of [{ x, y: -0.5 }, { x, y: height - 0.5 }, { x: -0.5, y }, { x: width - 0.5, y }]) {
      const ray = undistort(camera, pixel);
      if (ray) rays.push(ray);
    }
  }
  const box =
    rays.length === 0
      ? null
      : {
          left: Math.min(...rays.map((ray) => ray.x)),
          right: Math.max(...rays.map((ray) => ray.x)),
          top: Math.min(...rays.map((ray) => ray.y)),
          bottom: Math.max(...rays.map((ray) => ray.y)),
        };
  boxes.set(camera, box);
  return box;
}

/**
 * The epipolar curve in the camera `to` of a pixel of the camera `from`: where a point at that pixel would be seen, from
 * near to infinitely far. Empty when it never comes into the image.
 */
export function epipolarCurve(from: Camera, pixel: Point, to: Camera): Curve {
  const ray = undistort(from, pixel);
  const field = fieldOf(to);
  if (!ray || !field) return [];
  const [fx, fy, fz] = centre(from);
  const [tx, ty, tz] = centre(to);
  // In the camera `to`, and divided by its depth d along the ray, the point is b + s a with s = 1 / d from 0 to 1 / NEAREST.
  const a = turnBack(to, [fx - tx, fy - ty, fz - tz]);
  const b = turnBack(to, turn(from, [ray.x, ray.y, 1]));
  // Every border is a linear condition on b + s a: in front of the camera, and within its field of view.
  let [first, last] = [0, 1 / NEAREST];
  const keep = (f: (p: Vector) => number): void => {
    const [f0, f1] = [f(b), f(a)];
    if (f1 > 0) first = Math.max(first, -f0 / f1);
    else if (f1 < 0) last = Math.min(last, -f0 / f1);
    else if (f0 < 0) last = -1;
  };
  keep(([, , z]) => z - 1e-9);
  keep(([x, , z]) => x - field.left * z);
  keep(([x, , z]) => field.right * z - x);
  keep(([, y, z]) => y - field.top * z);
  keep(([, y, z]) => field.bottom * z - y);
  if (!(first < last)) return [];
  const flat = (s: number): Point => {
    const z = b[2] + s * a[2];
    return { x: (b[0] + s * a[0]) / z, y: (b[1] + s * a[1]) / z };
  };
  const [start, end] = [flat(first), flat(last)];
  const count = to.distortion.length === 0 ? 1 : SAMPLES;
  return Array.from({ length: count + 1 }, (_, k) => {
    const share = k / count;
    return distort(to, start.x + share * (end.x - start.x), start.y + share * (end.y - start.y));
  });
}

/** Distance of a point to a curve, px; infinite to an empty one. */
export function distanceToCurve(curve: Curve, point: Point): number {
  let best = Infinity;
  for (let k = 0; k + 1 < curve.length; k += 1) {
    const [p, q] = [curve[k], curve[k + 1]];
    if (!p || !q) continue;
    const [dx, dy] = [q.x - p.x, q.y - p.y];
    const length2 = dx * dx + dy * dy;
    const share = length2 > 0 ? Math.min(1, Math.max(0, ((point.x - p.x) * dx + (point.y - p.y) * dy) / length2)) : 0;
    best = Math.min(best, Math.hypot(p.x + share * dx - point.x, p.y + share * dy - point.y));
  }
  return best;
}
