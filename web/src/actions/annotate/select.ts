import { JOINT_COUNT, jointsOfFinger, otherHand, WRIST } from "../../model/joints";
import { activeKey, poseAt, type Action, type AnnotatorState } from "../../state/annotator";
import { nearestFrame, snapFrame, steppedFrame } from "../../model/frameSet";
import { firstOpenJoint, isEmpty, statusOf } from "../../model/pose";

export const selectJoint: Action<number> = (state, joint) => ({ ...state, joint, isChosen: true });

/** Next (+1) or previous (-1) joint, around. */
export const stepJoint: Action<1 | -1> = (state, step) => ({ ...state, joint: (state.joint + step + JOINT_COUNT) % JOINT_COUNT, isChosen: true });

/** A finger by number (0..4); again: the next joint along it. -1 is the wrist. */
export const selectFinger: Action<number> = (state, finger) => {
  if (finger < 0) return selectJoint(state, WRIST);
  const joints = jointsOfFinger(finger);
  const at = joints.indexOf(state.joint);
  return selectJoint(state, joints[(at + 1) % joints.length] ?? WRIST);
};

/** The other hand, at its first open joint. */
export const switchHand: Action = (state) => {
  const hand = otherHand(state.hand);
  const next = { ...state, hand, draft: null, isChosen: false };
  return { ...next, joint: openJoint(next) };
};

/** Go to a frame; the active joint stays when it is open there, otherwise the first open one is next. */
export const goToFrame: Action<number> = (state, frame) => {
  const wanted = Math.min(state.frameCount - 1, Math.max(0, Math.round(frame)));
  const within = state.frames ? snapFrame(state.frames, wanted, state.frame) : wanted;
  if (within === state.frame) return state;
  const next = { ...state, frame: within, draft: null, isChosen: false };
  return { ...next, joint: openJoint(next) };
};

/** Go so many frames on; where only some may be gone to, so many of those. */
export const stepFrames: Action<number> = (state, by) => goToFrame(state, state.frames ? steppedFrame(state.frames, state.frame, by) : state.frame + by);

/** From now on only these frames may be gone to; who is at another one is led to the nearest. */
export const keepToFrames: Action<readonly number[] | null> = (state, frames) => {
  const kept = { ...state, frames };
  return frames && !frames.includes(state.frame) ? goToFrame(kept, nearestFrame(frames, state.frame)) : kept;
};

export const selectCamera: Action<string> = (state, camera) => {
  if (camera === state.camera) return state;
  const next = { ...state, camera, draft: null, isChosen: false };
  return { ...next, joint: openJoint(next) };
};

/** Where to go on after coming to another image or hand: the same joint if it is open there too, else the first open one. */
function openJoint(state: AnnotatorState): number {
  const pose = poseAt(state, activeKey(state));
  return pose && !isEmpty(pose) && statusOf(pose[state.joint]) === "unset" ? state.joint : firstOpenJoint(pose);
}
