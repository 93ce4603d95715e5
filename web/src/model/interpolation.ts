/** What lies between two key frames, as a proposal: each joint that both have, on a straight line in time. */

import { isEmpty, isPlaced, keyText, parseKey, type Pose, type PoseKey } from "./pose";
import { ofIndependent } from "./source";
import type { SuggestedJoint, Suggestion } from "./suggestion";

/** Key frames of one hand in one camera that have an annotation, in order. */
export function keyFramesOf(keys: ReadonlySet<string>, poses: Readonly<Record<string, Pose>>, { camera, hand }: Omit<PoseKey, "frame">): number[] {
  return [...keys]
    .map(parseKey)
    .filter((key) => key.camera === camera && key.hand === hand && !isEmpty(poses[keyText(key)]))
    .map((key) => key.frame)
    .sort((a, b) => a - b);
}

/** The two key frames around a frame; on a key frame itself the span that begins there, or else the one that ends there. */
export function spanAt(frames: readonly number[], frame: number): readonly [number, number] | null {
  const to = frames.find((one) => one > frame) ?? (frames.at(-1) === frame ? frame : undefined);
  const from = to === undefined ? undefined : frames.findLast((one) => (to === frame ? one < frame : one <= frame));
  return from === undefined || to === undefined ? null : [from, to];
}

export function interpolate(from: Pose, to: Pose, share: number): (SuggestedJoint | null)[] {
  return from.map((a, joint) => {
    const b = to[joint];
    if (!isPlaced(a) || !isPlaced(b)) return null;
    const near = share < 0.5 ? a : b;
    return { px: [a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share], guess: near.v === 1 ? "occluded" : "visible", ...ofIndependent(a, b) };
  });
}

/** Proposals for every frame between two key frames, the ends left out. */
export function between(poses: Readonly<Record<string, Pose>>, hand: Omit<PoseKey, "frame">, [from, to]: readonly [number, number]): Suggestion[] {
  const [a, b] = [poses[keyText({ ...hand, frame: from })], poses[keyText({ ...hand, frame: to })]];
  if (!a || !b) return [];
  return Array.from({ length: to - from - 1 }, (_, index) => ({
    source: "interpolation",
    label: `key frames ${from} and ${to}`,
    place: { ...hand, frame: from + index + 1 },
    joints: interpolate(a, b, (index + 1) / (to - from)),
  }));
}
