/** What two fingers, or one that is drawn across, do to a picture. Pure. */

import { fitView, panBy, zoomAt, type Point, type Size, type View } from "./view";

/** As far as a finger is drawn across before it means another frame, px of the screen. */
const SWIPE = 48;

const middle = ([a, b]: readonly [Point, Point]): Point => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });
const spread = ([a, b]: readonly [Point, Point]): number => Math.max(1, Math.hypot(a.x - b.x, a.y - b.y));

/** What was under the fingers stays under them; a picture made smaller than the pane fits it (null). */
export function pinch(view: View, before: readonly [Point, Point], after: readonly [Point, Point], image: Size, pane: Size): View | null {
  const fit = fitView(image, pane);
  const zoomed = zoomAt(view, middle(before), spread(after) / spread(before), fit.scale * 0.5);
  if (zoomed.scale < fit.scale) return null;
  const [from, to] = [middle(before), middle(after)];
  return panBy(zoomed, { x: to.x - from.x, y: to.y - from.y }, image, pane);
}

/** 1 for the next frame (drawn to the left), -1 for the one before, 0 for neither. */
export function swipeOf(start: Point, end: Point): -1 | 0 | 1 {
  const [x, y] = [end.x - start.x, end.y - start.y];
  if (Math.abs(x) < SWIPE || Math.abs(x) < 1.5 * Math.abs(y)) return 0;
  return x < 0 ? 1 : -1;
}
