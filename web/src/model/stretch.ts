/** What the timeline of a moving scan shows, and which frames are chosen. */

import type { FrameRegistration } from "../api/movingScans";
import type { StripRow } from "../canvas/strip";
import { errorColor, SCAN_ERROR_FULL_MM } from "./errorColor";

/** Frames from the first to the last, both in it. */
export interface Stretch {
  readonly first: number;
  readonly last: number;
}

/** A stretch that begins, or ends, at a frame; one that would end before it begins is that frame alone. */
export const beginAt = (stretch: Stretch, frame: number): Stretch => ({ first: frame, last: Math.max(frame, stretch.last) });
export const endAt = (stretch: Stretch, frame: number): Stretch => ({ first: Math.min(frame, stretch.first), last: frame });

export const sayStretch = ({ first, last }: Stretch): string => (first === last ? `frame ${first}` : `frames ${first} to ${last}`);

export const countFrames = ({ first, last }: Stretch): number => last - first + 1;

export interface RowColors {
  readonly guessed: string;
  readonly accepted: string;
  readonly rejected: string;
  readonly chosen: string;
}

/** Names of the rows, as they stand beside them. */
export const ROWS = ["distance", "left guessed", "right guessed", "decision", "stretch"] as const;

/** One row for distances, guessed hands, decisions and the chosen stretch; a value of a decision above a half is one that accepts. */
export function movingRows(frames: readonly FrameRegistration[], count: number, stretch: Stretch | null, colors: RowColors): StripRow[] {
  const blank = (): number[] => Array.from({ length: count }, () => 0);
  const [distance, left, right, decision, chosen] = [blank(), blank(), blank(), blank(), blank()] as [number[], number[], number[], number[], number[]];
  for (const one of frames) {
    distance[one.frame] = one.mean_mm === null ? 0 : Math.min(1, Math.max(0.08, one.mean_mm / SCAN_ERROR_FULL_MM));
    left[one.frame] = one.guessed.includes("left") ? 1 : 0;
    right[one.frame] = one.guessed.includes("right") ? 1 : 0;
    decision[one.frame] = one.decision === "accept" ? 1 : one.decision === "reject" ? 0.5 : 0;
  }
  if (stretch) chosen.fill(1, stretch.first, stretch.last + 1);
  return [
    { label: ROWS[0], values: distance, color: errorColor },
    { label: ROWS[1], values: left, color: colors.guessed },
    { label: ROWS[2], values: right, color: colors.guessed },
    { label: ROWS[3], values: decision, color: (value) => (value > 0.5 ? colors.accepted : colors.rejected) },
    { label: ROWS[4], values: chosen, color: colors.chosen },
  ];
}

/** The next frame in a direction that is not good, or whose hands are guessed; null when there is none. */
export function nextDoubt(frames: readonly FrameRegistration[], frame: number, direction: 1 | -1): number | null {
  const doubtful = frames.filter((one) => one.verdict !== "good" || one.guessed.length > 0).map((one) => one.frame);
  const beyond = doubtful.filter((at) => (at - frame) * direction > 0);
  return (direction > 0 ? beyond[0] : beyond.at(-1)) ?? null;
}
