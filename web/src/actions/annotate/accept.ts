import { HANDS } from "../../model/joints";
import { keyText, nextOpenJoint } from "../../model/pose";
import { withAccepted } from "../../model/suggestion";
import { activeKey, activePose, withActivePose, type Action } from "../../state/annotator";
import { openJointsAt, type SuggestionsState } from "../../state/suggestions";

/** Take over what is suggested for the active joint, and go on to the next open one. */
export const acceptJoint: Action<SuggestionsState> = (state, suggestions) => {
  const open = openJointsAt(suggestions, state, activeKey(state));
  if (!open[state.joint]) return state;
  const pose = withAccepted(activePose(state), open, state.joint);
  return { ...withActivePose(state, pose), joint: nextOpenJoint(pose, state.joint), isChosen: false };
};

/** Take over what is suggested for the open joints of the active hand. */
export const acceptHand: Action<SuggestionsState> = (state, suggestions) => {
  const open = openJointsAt(suggestions, state, activeKey(state));
  if (open.every((joint) => joint === null)) return state;
  const pose = withAccepted(activePose(state), open);
  return { ...withActivePose(state, pose), joint: nextOpenJoint(pose, state.joint), isChosen: false };
};

/** Take over what is suggested for both hands in the images of some cameras: one step for undo, one save a hand. */
export const acceptAll: Action<{ suggestions: SuggestionsState; cameras: readonly string[] }> = (state, { suggestions, cameras }) => {
  const poses = { ...state.poses };
  for (const camera of cameras) {
    for (const hand of HANDS) {
      const place = { camera, frame: state.frame, hand };
      const open = openJointsAt(suggestions, state, place);
      if (open.some((joint) => joint !== null)) poses[keyText(place)] = withAccepted(poses[keyText(place)], open);
    }
  }
  if (Object.keys(poses).every((key) => poses[key] === state.poses[key])) return state;
  const next = { ...state, poses, draft: null };
  return { ...next, joint: nextOpenJoint(activePose(next), state.joint), isChosen: false };
};
