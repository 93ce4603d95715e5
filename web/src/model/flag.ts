/** What the label check says, for people. */

import type { Flag, FlagPage } from "../api/types";

export const KIND_NAMES: Record<Flag["kind"], string> = {
  outside: "Outside the image",
  finger_order: "Finger order",
  bone_length: "Bone length",
  depth: "Depth",
  background: "On the background",
  handedness: "Left or right",
  jump: "Jump",
  reprojection: "Other cameras",
  residual: "Far from the track",
  detector: "Far from the hand detector",
};

export const KINDS = Object.keys(KIND_NAMES) as Flag["kind"][];

/** Open flags of the whole recording. */
export const countOpen = (page: FlagPage): number => Object.values(page.counts).reduce((sum, count) => sum + (count ?? 0), 0);

const compare = (a: Flag, b: Flag): number => a.frame - b.frame || a.camera.localeCompare(b.camera) || a.hand.localeCompare(b.hand);

/** The next flagged label after a place (or before it), in the order of frames and around. */
export function nextFlag(flags: readonly Flag[], here: Pick<Flag, "frame" | "camera" | "hand">, direction: 1 | -1): Flag | undefined {
  const ordered = [...flags].sort(compare);
  const at = here as Flag;
  return direction === 1 ? (ordered.find((flag) => compare(flag, at) > 0) ?? ordered[0]) : (ordered.findLast((flag) => compare(flag, at) < 0) ?? ordered.at(-1));
}
