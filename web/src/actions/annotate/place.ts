import { activePose, withActivePose, type Action } from "../../state/annotator";
import { isPlaced, nextOpenJoint, withJoint } from "../../model/pose";
import { EDGES } from "../../model/joints";
import type { Point } from "../../canvas/view";
import { goToFrame } from "./select";

/** Put the active joint at a point (image px) and go on to the next open one. */
export const placeJoint: Action<Point> = (state, { x, y }) => {
  const pose = withJoint(activePose(state), state.joint, { x, y, v: 2 });
  return { ...withActivePose(state, pose), joint: nextOpenJoint(pose, state.joint) };
};

/** Where a click leads: to the next joint, to the same joint in the next frame, or nowhere. */
export const PLACE_MODES = ["joint", "frame", "stay"] as const;
export type PlaceMode = (typeof PLACE_MODES)[number];

/** Put the active joint at a point and go on as the person likes it. */
export const placeIn: Record<PlaceMode, Action<Point>> = {
  joint: placeJoint,
  frame: (state, point) => ({ ...goToFrame({ ...placeJoint(state, point), joint: state.joint }, state.frame + 1), joint: state.joint }),
  stay: (state, point) => ({ ...placeJoint(state, point), joint: state.joint }),
};

/** Without a mouse: put the active joint on the one it hangs on (or at the given middle), to be moved with the arrow keys. */
export const placeBeside: Action<Point> = (state, middle) => {
  const pose = activePose(state);
  if (isPlaced(pose[state.joint])) return state;
  const parent = EDGES.find(([, child]) => child === state.joint)?.[0];
  const from = parent === undefined ? undefined : pose[parent];
  const at = isPlaced(from) ? { x: from.x + 8, y: from.y - 8 } : middle;
  return withActivePose(state, withJoint(pose, state.joint, { x: at.x, y: at.y, v: 2 }));
};
