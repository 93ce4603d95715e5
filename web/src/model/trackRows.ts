/** A track as rows of the timeline. */

import type { TrackFrames } from "../api/types";
import type { StripRow } from "../canvas/strip";

export const ERROR_COLOR = "#8fa3b8";
export const LOST_COLOR = "#ff5d52";

/** The depth residual of each frame, full height at the worst; lost frames at full height in red above it. */
export function trackRows(track: TrackFrames, frameCount: number): StripRow[] {
  const error = new Float32Array(frameCount);
  const lost = new Float32Array(frameCount);
  const finite = track.depth_residual_mm.filter((value): value is number => value !== null && Number.isFinite(value));
  const worst = Math.max(1e-9, ...finite);
  track.frame.forEach((frame, index) => {
    if (frame < 0 || frame >= frameCount) return;
    const value = track.depth_residual_mm[index];
    error[frame] = value !== null && value !== undefined && Number.isFinite(value) ? value / worst : 0;
    lost[frame] = track.status[index] === "lost" ? 1 : 0;
  });
  const rows: StripRow[] = [{ label: "error", color: ERROR_COLOR, values: error }];
  return lost.some((value) => value > 0) ? [...rows, { label: "lost", color: LOST_COLOR, values: lost }] : rows;
}
