import { keyText, isEmpty, withJoint, withStatus } from "../../model/pose";
import { activeKey, activePose, poseAt, withActivePose, type Action } from "../../state/annotator";

/** Nobody has said anything about this joint. */
export const clearJoint: Action = (state) => {
  const pose = activePose(state);
  const point = pose[state.joint];
  if (!point || !poseAt(state, activeKey(state))) return state;
  const cleared = withJoint(pose, state.joint, withStatus(point, "unset"));
  return isEmpty(cleared) ? clearHand(state) : withActivePose(state, cleared);
};

/** The hand has no annotation in this image any more. */
export const clearHand: Action = (state) => {
  const { [keyText(activeKey(state))]: gone, ...poses } = state.poses;
  return gone ? { ...state, poses, draft: null, joint: 0, isChosen: false } : state;
};
