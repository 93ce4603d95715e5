import { expect, test } from "vitest";
import type { TriangulatedJoint, Triangulation } from "../api/triangulation";
import { emptyPose, keyText, withJoint } from "./pose";
import { canTriangulate, errorOf, gradeOf, markedViews, suggestViews, worstMarks } from "./triangulated";

const cameras = ["cam0", "cam1", "cam2"];
const mark = (joint: number, x: number) => withJoint(emptyPose(), joint, { x, y: 5, v: 2 });

test("only the hand and frame in question, and only cameras with a mark, take part", () => {
  const poses = {
    [keyText({ camera: "cam0", frame: 3, hand: "right" })]: mark(4, 10),
    [keyText({ camera: "cam1", frame: 3, hand: "left" })]: mark(4, 11),
    [keyText({ camera: "cam1", frame: 4, hand: "right" })]: mark(4, 12),
    [keyText({ camera: "cam2", frame: 3, hand: "right" })]: withJoint(emptyPose(), 0, { x: -1, y: -1, v: 0 }),
  };
  const views = markedViews(poses, cameras, 3, "right");
  expect(views.map((view) => view.camera)).toEqual(["cam0"]);
  expect(canTriangulate(views)).toBe(false);
});

test("two views must share a joint", () => {
  const at = (camera: string, joint: number) => ({ [keyText({ camera, frame: 0, hand: "right" as const })]: mark(joint, 1) });
  expect(canTriangulate(markedViews({ ...at("cam0", 1), ...at("cam2", 2) }, cameras, 0, "right"))).toBe(false);
  expect(canTriangulate(markedViews({ ...at("cam0", 2), ...at("cam2", 2) }, cameras, 0, "right"))).toBe(true);
});

const view = (camera: string, x: number | null, own: number | null, leftOut: number | null = null) => ({
  camera, x, y: x, is_seen: x !== null && x >= 0, is_used: own !== null, residual_px: own, left_out_px: leftOut,
});
const aside = (one: ReturnType<typeof view>) => ({ ...one, is_used: false });
const joint = (...views: ReturnType<typeof view>[]): TriangulatedJoint => ({ point: [0, 0, 0], angle_deg: 40, std_mm: 1, refusal: "", views });

test("the other views are filled with suggestions, inside the image and where nobody has marked", () => {
  const found: Triangulation = {
    joints: [
      joint(view("cam0", 1, 0.1), view("cam1", 2, 0.1), view("cam2", 3, null)),
      joint(view("cam0", 1, 0.1), view("cam1", 2, 0.1), view("cam2", -40, null)),
      { point: null, angle_deg: null, std_mm: null, refusal: "Marked in 1", views: cameras.map((name) => view(name, null, null)) },
    ],
  };
  const marks = [[1, 1, 2], [1, 1, 2], [1, 1, 2]] as [number, number, 0 | 1 | 2][];
  const [only, ...others] = suggestViews(found, [{ camera: "cam0", points: marks }, { camera: "cam1", points: marks }], { frame: 7, hand: "left" }, {});
  expect(others).toEqual([]);
  expect(only?.place).toEqual({ camera: "cam2", frame: 7, hand: "left" });
  expect(only?.label).toBe("cam0, cam1");
  expect(only?.joints).toEqual([{ px: [3, 3], guess: "visible" }, null, null]);
});

test("the worst mark comes first, judged by the others where there are enough of them", () => {
  const joints = [joint(view("cam0", 1, 0.5), view("cam1", 1, 0.4)), joint(view("cam0", 1, 2, 3), view("cam1", 1, 4, 9), view("cam2", 1, 2, 4))];
  expect(worstMarks(joints).map(({ joint, camera, error }) => [joint, camera, error])).toEqual([
    [1, "cam1", 9], [1, "cam2", 4], [1, "cam0", 3], [0, "cam0", 0.5], [0, "cam1", 0.4],
  ]);
  expect(errorOf(joint(view("cam0", 1, null)), view("cam0", 1, null))).toBeNull();
  expect([1.9, 4.9, 5.1].map(gradeOf)).toEqual(["good", "fair", "bad"]);
});

test("where one view is set aside the others are not blamed for it", () => {
  const one = joint(view("cam0", 1, 0.4, 4.6), view("cam1", 1, 0.3, 4.9), aside(view("cam2", 1, 10, 10)), view("cam3", 1, 0.2, 0.9));
  expect(worstMarks([one]).map(({ camera, error }) => `${camera} ${error}`)).toEqual(["cam2 10", "cam0 0.4", "cam1 0.3", "cam3 0.2"]);
});
