import { activePose, withActivePose, type Action, type AnnotatorState } from "../../state/annotator";
import { isPlaced, nextOpenJoint, statusOf, withJoint } from "../../model/pose";
import { EDGES } from "../../model/joints";
import type { Point } from "../../canvas/view";
import { goToFrame } from "./select";

/**
 * The joint that a click on the ground is about: the active one if it is open or the person chose it, else the next open one.
 * Null when every joint is decided: then a stray click must not move any.
 */
export function clickedJoint(state: AnnotatorState): number | null {
  const pose = activePose(state);
  const isOpen = (joint: number): boolean => statusOf(pose[joint]) === "unset";
  if (state.isChosen || isOpen(state.joint)) return state.joint;
  const next = nextOpenJoint(pose, state.joint);
  return isOpen(next) ? next : null;
}

/** Put the joint that a click is about at a point (image px) and go on to the next open one. */
export const placeJoint: Action<Point> = (state, { x, y }) => {
  const joint = clickedJoint(state);
  if (joint === null) return state;
  const pose = withJoint(activePose(state), joint, { x, y, v: 2 });
  return { ...withActivePose(state, pose), joint: nextOpenJoint(pose, joint), isChosen: false };
};

/** Where a click leads: to the next joint, to the same joint in the next frame, or nowhere. */
export const PLACE_MODES = ["joint", "frame", "stay"] as const;
export type PlaceMode = (typeof PLACE_MODES)[number];

/** The joint stays the one that clicks are about, as if it had been chosen again. */
const keepJoint = (state: AnnotatorState, joint: number): AnnotatorState => ({ ...state, joint, isChosen: true });

/** Put the joint that a click is about at a point and go on as the person likes it. */
export const placeIn: Record<PlaceMode, Action<Point>> = {
  joint: placeJoint,
  frame(state, point) {
    const joint = clickedJoint(state);
    return joint === null ? state : keepJoint(goToFrame(placeJoint(state, point), state.frame + 1), joint);
  },
  stay(state, point) {
    const joint = clickedJoint(state);
    return joint === null ? state : keepJoint(placeJoint(state, point), joint);
  },
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
