/** What the queue of frames to look at says, for people. */

import type { HandToLookAt } from "../api/types";

const SHOWN: Record<HandToLookAt["shows"], string> = {
  label: "The label is shown.",
  track: "Not labelled here: the track is shown.",
  detector: "Not labelled here: what the hand detector saw is shown.",
  nothing: "Nothing has the hand here: the whole image is shown.",
};

export const describeShown = (item: HandToLookAt): string => SHOWN[item.shows];

/** Whether anything looks wrong; the rest of the queue is there to be looked through all the same. */
export const isDoubtful = (item: HandToLookAt): boolean => item.score >= 1;

/** The joints that the worst doubt means, where it is about the camera that is shown. */
export function findMeant(item: HandToLookAt): number[] {
  const first = item.doubts[0];
  return first && (first.camera === null || first.camera === item.camera) ? first.joints : [];
}
