/** How far each frame is annotated, hand by hand, and what else is to be said of it. */

import type { Side } from "../api/types";
import type { FrameMark } from "./frameMarks";
import { HANDS, JOINT_COUNT } from "./joints";
import { decidedCount, parseKey, type Pose } from "./pose";
import { openJoints, type Source, type SuggestionsOfHand } from "./suggestion";

export interface HandFrames {
  readonly hand: Side;
  /** Joints decided, 0..21, for each frame. */
  readonly decided: Uint8Array;
  readonly key: ReadonlySet<number>;
  readonly suggested: ReadonlySet<number>;
}

/** What is annotated in one camera, and where a person set key frames. */
export function handFrames(poses: Readonly<Record<string, Pose>>, keys: ReadonlySet<string>, frameCount: number, camera: string): HandFrames[] {
  const rows = HANDS.map((hand) => ({ hand, decided: new Uint8Array(frameCount), key: new Set<number>(), suggested: new Set<number>() }));
  for (const [text, pose] of Object.entries(poses)) {
    const key = parseKey(text);
    const row = rows[HANDS.indexOf(key.hand)];
    if (row && key.camera === camera && key.frame < frameCount) row.decided[key.frame] = decidedCount(pose);
  }
  for (const text of keys) {
    const key = parseKey(text);
    if (key.camera === camera && key.frame < frameCount) rows[HANDS.indexOf(key.hand)]?.key.add(key.frame);
  }
  return rows;
}

/** The same with the frames in which something proposed could still be accepted. */
export function withSuggested(
  rows: readonly HandFrames[],
  poses: Readonly<Record<string, Pose>>,
  byPlace: Readonly<Record<string, SuggestionsOfHand>>,
  hidden: ReadonlySet<Source>,
  camera: string,
): HandFrames[] {
  const suggested = rows.map(() => new Set<number>());
  for (const [text, suggestions] of Object.entries(byPlace)) {
    const key = parseKey(text);
    if (key.camera === camera && openJoints(suggestions, poses[text], hidden).some((joint) => joint !== null)) suggested[HANDS.indexOf(key.hand)]?.add(key.frame);
  }
  return rows.map((row, index) => ({ ...row, suggested: suggested[index] ?? row.suggested }));
}

export type Progress = "none" | "partial" | "complete";

export const progressOf = (decided: number): Progress => (decided === 0 ? "none" : decided >= JOINT_COUNT ? "complete" : "partial");

/** A frame in words, for the hint under the pointer. */
export function describeFrame(frame: number, rows: readonly HandFrames[], marks: Readonly<Record<FrameMark, ReadonlySet<number>>>): string[] {
  const hands = rows.map((row) => {
    const decided = row.decided[frame] ?? 0;
    const parts = [decided === 0 ? "not marked" : decided >= JOINT_COUNT ? "complete" : `${decided} of ${JOINT_COUNT}`];
    if (row.key.has(frame)) parts.push("key frame");
    if (row.suggested.has(frame) || marks.suggested.has(frame)) parts.push("suggested");
    return `${row.hand}: ${parts.join(", ")}`;
  });
  return [...hands, ...(marks.flagged.has(frame) ? ["flagged by label QC"] : []), ...(marks.submitted.has(frame) ? ["submitted"] : [])];
}
