import { expect, test } from "vitest";
import type { Camera } from "../api/types";
import golden from "./epipolar.golden.json";
import { distanceToCurve, distort, epipolarCurve, undistort } from "./epipolar";

const cameras = golden.cameras as unknown as Camera[];
const named = (id: string): Camera => cameras.find((camera) => camera.id === id) as Camera;

test("pixels and rays are the tracker's, with every distortion of OpenCV", () => {
  for (const { camera, ray, pixel } of golden.rays) {
    const found = distort(named(camera), ray[0] ?? 0, ray[1] ?? 0);
    expect(Math.hypot(found.x - (pixel[0] ?? 0), found.y - (pixel[1] ?? 0)), camera).toBeLessThan(1e-6);
    const back = undistort(named(camera), { x: pixel[0] ?? 0, y: pixel[1] ?? 0 });
    expect(Math.hypot((back?.x ?? NaN) - (ray[0] ?? 0), (back?.y ?? NaN) - (ray[1] ?? 0)), camera).toBeLessThan(1e-6);
  }
});

test("the epipolar curve passes through where the other camera sees the point, at whatever depth", () => {
  for (const { from, pixel, to, seen } of golden.points) {
    const curve = epipolarCurve(named(from), { x: pixel[0] ?? 0, y: pixel[1] ?? 0 }, named(to));
    expect(distanceToCurve(curve, { x: seen[0] ?? 0, y: seen[1] ?? 0 }), `${from} to ${to}`).toBeLessThan(0.05);
  }
});

test("a curve stays where the camera can see", () => {
  for (const { from, pixel, to } of golden.points) {
    const camera = named(to);
    for (const point of epipolarCurve(named(from), { x: pixel[0] ?? 0, y: pixel[1] ?? 0 }, camera)) {
      expect(point.x).toBeGreaterThan(-0.6 * camera.width);
      expect(point.x).toBeLessThan(1.6 * camera.width);
    }
  }
});

test("a ray that runs behind the other camera, and a pixel beyond the lens, have no curve", () => {
  const [first] = cameras;
  if (!first) throw new Error("no camera");
  // Looks away from it, from behind.
  const behind: Camera = { ...first, id: "behind", T_world_camera: [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -2], [0, 0, 0, 1]] };
  const plain: Camera = { ...first, id: "plain", T_world_camera: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]] };
  expect(epipolarCurve(plain, { x: 320, y: 240 }, behind)).toEqual([]);
  const folded: Camera = { ...plain, distortion: [-0.4, 0, 0, 0], K: [[500, 0, 320], [0, 500, 240], [0, 0, 1]] };
  expect(undistort(folded, { x: 627, y: 240 })).toBeNull();
  expect(undistort(folded, { x: 620, y: 240 })).not.toBeNull();
});

test("a curve takes well under a millisecond: the cursor is followed without lag", () => {
  const [point] = golden.points;
  if (!point) throw new Error("no point");
  const began = performance.now();
  for (let k = 0; k < 1000; k += 1) epipolarCurve(named(point.from), { x: (k * 7) % 640, y: (k * 3) % 480 }, named(point.to));
  expect((performance.now() - began) / 1000).toBeLessThan(1);
});
