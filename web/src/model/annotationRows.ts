/** What is annotated, as rows of the timeline. */

import type { StripRow } from "../canvas/strip";
import { HAND_COLORS, HANDS, JOINT_COUNT } from "./joints";
import { decidedCount, parseKey, type Pose } from "./pose";

/** One row a hand; the height of a mark is the share of its joints that are decided (seen from any camera, or one). */
export function annotationRows(poses: Readonly<Record<string, Pose>>, frameCount: number, camera?: string): StripRow[] {
  const rows = HANDS.map((hand) => ({ label: hand, color: HAND_COLORS[hand], values: new Float32Array(frameCount) }));
  for (const [text, pose] of Object.entries(poses)) {
    const key = parseKey(text);
    const row = rows[HANDS.indexOf(key.hand)];
    if (!row || key.frame >= frameCount || (camera !== undefined && key.camera !== camera)) continue;
    row.values[key.frame] = Math.max(row.values[key.frame] ?? 0, decidedCount(pose) / JOINT_COUNT);
  }
  return rows;
}
