/** A track as rows of the timeline. */

import type { TrackFrames } from "../api/types";
import type { StripRow } from "../canvas/strip";
import { errorColor } from "./errorColor";
import { frameError } from "./frameError";

export const LOST_COLOR = "#ff5d52";

/** The error of each frame; lost frames in a row of their own. */
export function trackRows(track: TrackFrames, frameCount: number): StripRow[] {
  const error = new Float32Array(frameCount);
  const lost = new Float32Array(frameCount);
  const { values, full } = frameError(track);
  track.frame.forEach((frame, index) => {
    if (frame < 0 || frame >= frameCount) return;
    const here = values[index];
    // A good frame still shows a sliver, so that it is told from one that is not in the track.
    if (typeof here === "number" && Number.isFinite(here)) error[frame] = Math.min(1, Math.max(0.08, here / full));
    lost[frame] = track.status[index] === "lost" ? 1 : 0;
  });
  const rows: StripRow[] = [{ label: "error", color: errorColor, values: error }];
  return lost.some((value) => value > 0) ? [...rows, { label: "lost", color: LOST_COLOR, values: lost }] : rows;
}
