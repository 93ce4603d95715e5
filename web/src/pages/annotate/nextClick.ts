/** What the next click does, or why it does nothing. */

import { clickedJoint, type PlaceMode } from "../../actions/annotate/place";
import type { Pictures } from "../../canvas/usePictures";
import { jointLabel } from "../../model/joints";
import { statusOf, type Pose } from "../../model/pose";
import type { AnnotatorState } from "../../state/annotator";

/** `over` is the joint that a click chooses where the pointer is; null on the ground. */
export function describeClick(state: AnnotatorState, pose: Pose, placeMode: PlaceMode, over: number | null = null): string {
  if (over !== null && state.draft === null) {
    const ground = clickedJoint(state) === null ? "" : `; with Shift it ${describeClick(state, pose, placeMode)}`;
    return `chooses the ${state.hand} ${jointLabel(over)}${ground}`;
  }
  const joint = clickedJoint(state);
  if (joint === null) return `changes nothing: all joints of the ${state.hand} hand are marked. Drag a joint, or select it first`;
  const name = `${state.hand} ${jointLabel(joint)}`;
  const status = statusOf(pose[joint]);
  const after = placeMode === "frame" ? ", then the next frame" : "";
  if (status === "unset") return `places the ${name}${after}`;
  return status === "outside" ? `places the ${name}, which is outside now` : `moves the ${name} here${after}`;
}

/** Why nothing can be changed in the picture now; null when it can. */
export function describeWait(frame: number, pictures: Pictures | null, isPlaying: boolean, isRefused: boolean): string | null {
  if (isPlaying) return "Playing: pause to change something";
  if (pictures?.setback && pictures.color === null && pictures.depth === null) return `The picture of frame ${frame} could not be loaded: nothing can be changed in it`;
  if (pictures?.setback && pictures.isStale) return `The picture of frame ${frame} is not here yet, the studio does not answer; nothing can be changed until it is here`;
  if (!pictures || pictures.isStale) return `${isRefused ? "No effect: the" : "The"} picture of frame ${frame} is on its way; nothing can be changed until it is here`;
  return null;
}
