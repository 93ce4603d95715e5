/** Frames of a track that want a look. */

import type { TrackFrames } from "../api/types";
import { frameError } from "./frameError";

/** Lost frames in order; when none is lost, the tenth with the largest error. */
export function badFrames(track: TrackFrames): number[] {
  const lost = track.frame.filter((_, index) => track.status[index] === "lost");
  if (lost.length > 0) return lost;
  const { values } = frameError(track);
  const byError = track.frame.map((frame, index) => ({ frame, error: values[index] ?? -1 })).sort((a, b) => b.error - a.error);
  const count = Math.max(1, Math.ceil(track.frame.length / 10));
  return byError
    .slice(0, count)
    .map(({ frame }) => frame)
    .sort((a, b) => a - b);
}

/** The next one after a frame (or before it), going around. */
export function nextIn(frames: readonly number[], frame: number, direction: 1 | -1): number | undefined {
  if (direction === 1) return frames.find((candidate) => candidate > frame) ?? frames[0];
  return frames.findLast((candidate) => candidate < frame) ?? frames.at(-1);
}
