import { isEmpty, parseKey, statusOf, type Pose } from "../../model/pose";
import { ofIndependent } from "../../model/source";
import { withActivePose, type Action, type AnnotatorState } from "../../state/annotator";

/** Frames of this camera with an annotation of the given hand (or any), in order. */
export function annotatedFrames(state: Pick<AnnotatorState, "poses" | "camera">, hand?: string): number[] {
  const frames = Object.entries(state.poses).flatMap(([text, pose]) => {
    const key = parseKey(text);
    return key.camera === state.camera && (!hand || key.hand === hand) && !isEmpty(pose) ? [key.frame] : [];
  });
  return [...new Set(frames)].sort((a, b) => a - b);
}

/** The pose as another frame gets it: its joints say that nobody placed them there. */
export const copyOf = (pose: Pose, frame: number): Pose => pose.map((point) => (statusOf(point) === "unset" ? point : { ...point, from: { kind: "copy", label: `frame ${frame}`, ...ofIndependent(point) } }));

/** The pose of the last annotated frame before this one, flags and all. One step for undo. */
export const bringPose: Action = (state) => {
  const from = annotatedFrames(state, state.hand).findLast((frame) => frame < state.frame);
  const pose = from === undefined ? undefined : state.poses[`${from}|${state.hand}|${state.camera}`];
  return pose && from !== undefined ? withActivePose(state, copyOf(pose, from)) : state;
};
