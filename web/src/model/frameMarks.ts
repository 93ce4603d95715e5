/** What the timeline says of a frame besides how far it is annotated. */

export type FrameMark = "key" | "suggested" | "flagged" | "submitted";

export type FrameMarks = Readonly<Partial<Record<FrameMark, ReadonlySet<number>>>>;

export const FRAME_MARKS: readonly FrameMark[] = ["key", "suggested", "flagged", "submitted"];

/** All marks of several sources. */
export function mergeMarks(sources: readonly FrameMarks[]): Readonly<Record<FrameMark, ReadonlySet<number>>> {
  const merged: Record<FrameMark, Set<number>> = { key: new Set(), suggested: new Set(), flagged: new Set(), submitted: new Set() };
  for (const source of sources) {
    for (const mark of FRAME_MARKS) source[mark]?.forEach((frame) => merged[mark].add(frame));
  }
  return merged;
}
