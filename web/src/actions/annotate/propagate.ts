import { isEmpty, keyText, type Pose } from "../../model/pose";
import { activeKey, poseAt, type Action, type AnnotatorState } from "../../state/annotator";
import { copyOf } from "./bring";
import { goToFrame } from "./select";

/** The frames after this one up to `last` (or the end) in which this hand has no annotation yet, up to the next that has one. */
export function openFramesAhead(state: AnnotatorState, last = state.frameCount - 1): number[] {
  const frames: number[] = [];
  for (let frame = state.frame + 1; frame <= Math.min(last, state.frameCount - 1); frame += 1) {
    if (!isEmpty(poseAt(state, { ...activeKey(state), frame }))) break;
    frames.push(frame);
  }
  return frames;
}

const carried = (state: AnnotatorState, pose: Pose, frames: readonly number[]): AnnotatorState => ({
  ...state,
  draft: null,
  poses: { ...state.poses, ...Object.fromEntries(frames.map((frame) => [keyText({ ...activeKey(state), frame }), copyOf(pose, state.frame)])) },
});

/** Carry this pose on to the next frame and go there. A frame that has one already is only gone to. */
export const propagateOn: Action = (state) => {
  const pose = poseAt(state, activeKey(state));
  if (!pose || isEmpty(pose)) return state;
  const next = goToFrame(carried(state, pose, openFramesAhead(state, state.frame + 1)), state.frame + 1);
  return { ...next, joint: state.joint };
};

/** Carry a hand's pose (`keyText`, if it is the active one still) on up to a frame, at most up to the next annotated one: one step for undo. */
export const propagateTo: Action<{ key: string; last: number }> = (state, { key, last }) => {
  if (keyText(activeKey(state)) !== key) return state;
  const pose = poseAt(state, activeKey(state));
  const frames = openFramesAhead(state, last);
  return pose && !isEmpty(pose) && frames.length > 0 ? carried(state, pose, frames) : state;
};
