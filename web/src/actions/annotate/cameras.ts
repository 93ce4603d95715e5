import { firstOpenJoint, statusOf } from "../../model/pose";
import { activeKey, activePose, poseAt, type Action } from "../../state/annotator";

/**
 * Go to another camera of the same moment, as a gesture in its picture does: the joint stays, so that it can be marked
 * there too. Only after a finished hand, and unless somebody chose the joint, the other picture's first open joint is next.
 */
export const activateCamera: Action<string> = (state, camera) => {
  if (camera === state.camera) return state;
  const isFinished = activePose(state).every((point) => statusOf(point) !== "unset");
  const next = { ...state, camera, draft: null };
  return isFinished && !state.isChosen ? { ...next, joint: firstOpenJoint(poseAt(next, activeKey(next))) } : next;
};
