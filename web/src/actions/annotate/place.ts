import { activePose, withActivePose, type Action, type AnnotatorState } from "../../state/annotator";
import { statusOf, withJoint, type Pose } from "../../model/pose";
import { JOINT_COUNT } from "../../model/joints";
import type { Point } from "../../canvas/view";

/** The joint to do after this one: the next that nobody has decided about, or the same when all are done. */
export function nextOpenJoint(pose: Pose, joint: number): number {
  for (let step = 1; step <= JOINT_COUNT; step += 1) {
    const candidate = (joint + step) % JOINT_COUNT;
    if (statusOf(pose[candidate]) === "unset") return candidate;
  }
  return joint;
}

/** Put the active joint at a point (image px) and go on to the next open one. */
export const placeJoint: Action<Point> = (state, { x, y }) => {
  const pose = withJoint(activePose(state), state.joint, { x, y, v: 2 });
  return { ...withActivePose(state, pose), joint: nextOpenJoint(pose, state.joint) };
};

/** What the next click will do, for the status line. */
export function isComplete(state: AnnotatorState): boolean {
  return activePose(state).every((point) => statusOf(point) !== "unset");
}
