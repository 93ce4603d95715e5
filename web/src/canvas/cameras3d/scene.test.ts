import { expect, test } from "vitest";
import { centreOf, drawBoard, drawCamera, findBall } from "./scene";

const T = [[0, 0, 1, 2], [0, 1, 0, 0], [-1, 0, 0, 3], [0, 0, 0, 1]];

test("a camera's rays go through the corners of its picture", () => {
  const points = drawCamera({ id: "a", width: 200, height: 100, K: [[100, 0, 99.5], [0, 100, 49.5], [0, 0, 1]], T_world_camera: T, color: "#fff" }, 0.5);
  expect(centreOf(T)).toEqual([2, 0, 3]);
  expect(points[0]).toEqual([2, 0, 3]);
  // x right of the camera is -z of the world, its z is x of the world.
  expect(points[1]).toEqual([2.5, -0.25, 3.5]);
  expect(points[3]).toEqual([2.5, -0.25, 2.5]);
});

test("a board is a rectangle from its corner", () => {
  const points = drawBoard([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 0, 1]], 0.2, 0.1);
  expect(points).toHaveLength(8);
  expect(points[1]).toEqual([1.2, 1, 1]);
  const ball = findBall(points);
  expect(ball.middle).toEqual([1.1, 1.05, 1]);
  expect(ball.radius).toBeCloseTo(Math.hypot(0.1, 0.05), 6);
});
