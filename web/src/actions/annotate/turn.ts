import type { Point } from "../../canvas/view";
import { hasPlace } from "../../model/pose";
import { activeKey, poseAt, type Action } from "../../state/annotator";

/** A turn (radians, clockwise on the screen) and a growth (factor) about a point of the image. */
export interface Turn {
  readonly about: Point;
  readonly angle: number;
  readonly factor: number;
}

/** While the wheel turns: the whole hand, from where it was before the first of these. */
export const turnHand: Action<Turn> = (state, { about, angle, factor }) => {
  const start = poseAt(state, activeKey(state));
  if (!start) return state;
  const [cos, sin] = [factor * Math.cos(angle), factor * Math.sin(angle)];
  return {
    ...state,
    draft: start.map((point) => {
      if (!hasPlace(point)) return point;
      const [x, y] = [point.x - about.x, point.y - about.y];
      return { v: point.v, x: about.x + cos * x - sin * y, y: about.y + sin * x + cos * y };
    }),
  };
};
