import { expect, test } from "vitest";
import type { TriangulatedJoint } from "../api/triangulation";
import type { Camera } from "../api/types";
import { fitView, toScreen } from "../canvas/view";
import { lookAt } from "./look";
import { emptyPose, withJoint } from "./pose";

const camera = { id: "cam1", width: 640, height: 480 } as Camera;
const pane = { width: 400, height: 300 };

test("the joint comes to the middle, larger", () => {
  const view = lookAt(camera, pane, withJoint(emptyPose(), 4, { x: 100, y: 50, v: 1 }), null, 4);
  expect(view && toScreen(view, { x: 100, y: 50 })).toEqual({ x: 200, y: 150 });
  expect(view?.scale).toBeCloseTo(5 * fitView(camera, pane).scale);
});

test("where it is not marked, the other cameras say where it is", () => {
  const seen: TriangulatedJoint = { point: [0, 0, 1], angle_deg: 9, std_mm: 1, refusal: "", views: [{ camera: "cam1", x: 30, y: 40, is_seen: true, is_used: false, residual_px: null, left_out_px: null }] };
  const view = lookAt(camera, pane, undefined, [seen], 0);
  expect(view && toScreen(view, { x: 30, y: 40 })).toEqual({ x: 200, y: 150 });
  expect(lookAt({ ...camera, id: "cam2" }, pane, undefined, [seen], 0)).toBeNull();
});

test("a hand is shown whole", () => {
  const pose = withJoint(withJoint(emptyPose(), 0, { x: 100, y: 400, v: 2 }), 12, { x: 300, y: 100, v: 2 });
  const view = lookAt(camera, pane, pose, null, null);
  if (!view) throw new Error("no view");
  for (const place of [{ x: 100, y: 400 }, { x: 300, y: 100 }]) {
    const at = toScreen(view, place);
    expect(at.x > 0 && at.x < pane.width && at.y > 0 && at.y < pane.height).toBe(true);
  }
});
