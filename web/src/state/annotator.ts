/** What the annotator knows: poses in image pixels and where the person is. No screen coordinate ever gets in here. */

import type { Side } from "../api/types";
import { emptyPose, keyText, type Pose, type PoseKey } from "../model/pose";

export interface AnnotatorState {
  /** By `keyText`. What is missing here has no annotation. */
  readonly poses: Readonly<Record<string, Pose>>;
  readonly camera: string;
  readonly frame: number;
  readonly frameCount: number;
  /** The only frames that may be gone to, in order (those of a blind replica); null for all. */
  readonly frames: readonly number[] | null;
  readonly hand: Side;
  readonly joint: number;
  /** The person chose the joint, so that a click may move it although it is decided; nobody did when it only came next. */
  readonly isChosen: boolean;
  /** A drag that has not ended: drawn instead of the stored pose, neither saved nor undoable yet. */
  readonly draft: Pose | null;
}

/** An action takes state and returns state; nothing else. */
export type Action<Input = void> = (state: AnnotatorState, input: Input) => AnnotatorState;

export const activeKey = (state: AnnotatorState): PoseKey => ({ camera: state.camera, frame: state.frame, hand: state.hand });

export const poseAt = (state: AnnotatorState, key: PoseKey): Pose | undefined => state.poses[keyText(key)];

/** The active hand as it is to be drawn; empty when it has no annotation yet. */
export const activePose = (state: AnnotatorState): Pose => state.draft ?? poseAt(state, activeKey(state)) ?? emptyPose();

/** The active hand in any camera's picture of this frame, as it is to be drawn. */
export const poseIn = (state: AnnotatorState, camera: string): Pose =>
  camera === state.camera ? activePose(state) : (poseAt(state, { ...activeKey(state), camera }) ?? emptyPose());

/** Store a pose for the active hand (and end a drag). */
export const withActivePose = (state: AnnotatorState, pose: Pose): AnnotatorState => ({
  ...state,
  draft: null,
  poses: { ...state.poses, [keyText(activeKey(state))]: pose },
});

/** Keys whose pose differs between two states. */
export function changedKeys(now: AnnotatorState["poses"], before: AnnotatorState["poses"]): string[] {
  if (now === before) return [];
  const keys = new Set([...Object.keys(now), ...Object.keys(before)]);
  return [...keys].filter((key) => now[key] !== before[key]);
}
