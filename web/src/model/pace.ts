/** How fast somebody decides, and how long the rest will take. */

/** A pause that is longer than this is none of the work, s. */
export const PAUSE_S = 60;
/** Only so many of the last decisions count: the pace of now, not of this morning. */
const RECENT = 30;

export interface Pace {
  /** Decisions a minute; null before the second one. */
  readonly perMinute: number | null;
  /** For what is left at this pace, s. */
  readonly secondsLeft: number | null;
}

/** @param times when each decision was made, ms, oldest first. */
export function paceOf(times: readonly number[], left: number): Pace {
  const recent = times.slice(-RECENT);
  const gaps = recent.slice(1).map((time, at) => (time - (recent[at] as number)) / 1000);
  const worked = gaps.filter((gap) => gap >= 0 && gap <= PAUSE_S);
  const seconds = worked.reduce((sum, gap) => sum + gap, 0);
  if (worked.length === 0 || seconds === 0) return { perMinute: null, secondsLeft: null };
  const perMinute = (60 * worked.length) / seconds;
  return { perMinute, secondsLeft: (60 * left) / perMinute };
}
