/** Going about in a recording of which only some frames are asked for. Sets are in order and not empty. */

/** The frame of the set that stands in for a wanted one: the next in the direction of travel, else the last there is. */
export function snapFrame(frames: readonly number[], wanted: number, from: number): number {
  if (frames.includes(wanted)) return wanted;
  const next = wanted >= from ? frames.find((frame) => frame > wanted) : frames.findLast((frame) => frame < wanted);
  return next ?? (wanted >= from ? frames.at(-1) : frames[0]) ?? wanted;
}

/** So many frames of the set further on, at most to its ends. */
export function steppedFrame(frames: readonly number[], from: number, by: number): number {
  const at = frames.indexOf(from);
  if (at < 0) return snapFrame(frames, from + by, from);
  return frames[Math.min(frames.length - 1, Math.max(0, at + by))] ?? from;
}

/** The frame of the set that is least far from a wanted one. */
export const nearestFrame = (frames: readonly number[], wanted: number): number =>
  frames.reduce((best, frame) => (Math.abs(frame - wanted) < Math.abs(best - wanted) ? frame : best), frames[0] ?? wanted);
