import { activePose, poseAt, activeKey, withActivePose, type Action } from "../../state/annotator";
import { hasPlace, isPlaced, withJoint } from "../../model/pose";
import type { Point } from "../../canvas/view";

/** During a drag: the joint follows the pointer (image px). A dragged joint that was outside is visible again. */
export const dragJoint: Action<{ joint: number; to: Point }> = (state, { joint, to }) => {
  const pose = activePose(state);
  const point = pose[joint];
  if (!point) return state;
  return { ...state, joint, isChosen: false, draft: withJoint(pose, joint, { x: to.x, y: to.y, v: point.v === 1 ? 1 : 2 }) };
};

/** During a drag with Alt: the whole hand goes by an offset from where the drag began (image px). */
export const dragHand: Action<Point> = (state, { x, y }) => {
  const start = poseAt(state, activeKey(state));
  if (!start) return state;
  return { ...state, draft: start.map((point) => (hasPlace(point) ? { x: point.x + x, y: point.y + y, v: point.v } : point)) };
};

/** The drag is over: keep what is drawn. */
export const endDrag: Action = (state) => (state.draft ? withActivePose(state, state.draft) : state);

/** The drag is called off. */
export const cancelDrag: Action = (state) => (state.draft ? { ...state, draft: null } : state);

/** Move the active joint by an offset (image px). */
export const nudgeJoint: Action<Point> = (state, { x, y }) => {
  const pose = activePose(state);
  const point = pose[state.joint];
  if (!isPlaced(point)) return state;
  return withActivePose(state, withJoint(pose, state.joint, { x: point.x + x, y: point.y + y, v: point.v }));
};
