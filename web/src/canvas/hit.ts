import type { Pose } from "../model/pose";
import { isShown } from "../model/pose";
import { toScreen, type Point, type View } from "./view";

/** How near to a joint a press counts as on it, px of the screen. */
export const HIT_RADIUS = 10;

/** While another joint waits to be placed, a click this near to one still chooses it, px of the screen: the disc that is drawn. */
export const CHOOSE_RADIUS = 6;

/** The joint, placed or outside with a place, nearest to a screen point, or -1; among equally near ones the active joint wins. */
export function jointAt(pose: Pose, view: View, screen: Point, active: number, radius = HIT_RADIUS): number {
  let best = -1;
  let bestDistance = radius;
  pose.forEach((point, joint) => {
    if (!isShown(point)) return;
    const at = toScreen(view, point);
    const distance = Math.hypot(at.x - screen.x, at.y - screen.y) - (joint === active ? 2 : 0);
    if (distance < bestDistance) {
      best = joint;
      bestDistance = distance;
    }
  });
  return best;
}
