/** Zooming a picture to a joint or a hand. */

import type { TriangulatedJoint } from "../api/triangulation";
import type { Camera } from "../api/types";
import { fitView, PIXEL_CENTRE, type Point, type Size, type View } from "../canvas/view";
import { isPlaced, type Pose } from "./pose";

/** A joint is looked at this much larger than the whole image. */
const JOINT_ZOOM = 5;
const MARGIN = 1.3;

/** The view that shows a joint (or null: the hand) in the middle; null, the whole image, where nobody knows where it is. */
export function lookAt(camera: Camera, pane: Size, pose: Pose | undefined, joints: readonly TriangulatedJoint[] | null, joint: number | null): View | null {
  const placeOf = (index: number): Point | null => {
    const mark = pose?.[index];
    if (isPlaced(mark)) return mark;
    const view = joints?.[index]?.views.find((one) => one.camera === camera.id);
    return view?.is_seen && view.x !== null && view.y !== null ? { x: view.x, y: view.y } : null;
  };
  const indices = joint === null ? Array.from({ length: 21 }, (_, index) => index) : [joint];
  const places = indices.flatMap((index) => placeOf(index) ?? []);
  if (places.length === 0) return null;
  const [xs, ys] = [places.map((place) => place.x), places.map((place) => place.y)];
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const whole = fitView(camera, pane).scale;
  const filling = Math.min(pane.width / (MARGIN * (right - left) + 1), pane.height / (MARGIN * (bottom - top) + 1));
  const scale = Math.max(whole, Math.min(JOINT_ZOOM * whole, filling));
  return {
    scale,
    x: pane.width / 2 - scale * ((left + right) / 2 + PIXEL_CENTRE),
    y: pane.height / 2 - scale * ((top + bottom) / 2 + PIXEL_CENTRE),
  };
}
