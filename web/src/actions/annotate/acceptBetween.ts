import { between } from "../../model/interpolation";
import { keyText } from "../../model/pose";
import { sourceOf, withAccepted } from "../../model/suggestion";
import type { Action } from "../../state/annotator";

/** Take over what is proposed between two key frames of the active hand; joints that somebody decided stay. One step for undo. */
export const acceptBetween: Action<readonly [number, number]> = (state, span) => {
  const accepted = between(state.poses, { camera: state.camera, hand: state.hand }, span).flatMap((suggestion) => {
    const key = keyText(suggestion.place);
    const pose = withAccepted(state.poses[key], suggestion.joints.map((joint) => joint && { ...joint, from: sourceOf(suggestion, joint) }));
    return state.poses[key]?.every((point, joint) => point === pose[joint]) ? [] : [[key, pose] as const];
  });
  return accepted.length > 0 ? { ...state, poses: { ...state.poses, ...Object.fromEntries(accepted) } } : state;
};
