/** The revisions of a hand as a person reads them. */

import type { AnnotationRevision, JointSource } from "../api/types";
import { emptyPose, fromWire, kept, samePose, statusOf, type Pose } from "./pose";

export interface HistoryEntry {
  readonly revision: number;
  readonly author: string;
  readonly at: string;
  readonly pose: Pose;
  readonly isDeleted: boolean;
  /** "index tip moved", "3 joints changed" */
  readonly changed: readonly number[];
  /** None of what changed was decided before. */
  readonly isNew: boolean;
  /** An earlier revision that was just like this one. */
  readonly sameAs: number | null;
}

const KINDS: Record<JointSource["kind"], string> = {
  track: "",
  fit: "",
  detector: "",
  triangulation: "triangulated from ",
  interpolation: "between ",
  copy: "copied from ",
  import: "imported: ",
};

/** Where a joint came from, in words. */
export const describeSource = (from: JointSource | undefined): string => (from ? `${KINDS[from.kind]}${from.label || from.kind}` : "by hand");

/** Where the changed joints came from, in words: "17 from Track 2, 4 by hand". Empty when a hand placed them all. */
export function describeSources({ pose, changed }: HistoryEntry): string {
  const counts = new Map<string, number>();
  for (const joint of changed) {
    const point = pose[joint];
    if (point && statusOf(point) !== "unset") counts.set(describeSource(point.from), (counts.get(describeSource(point.from)) ?? 0) + 1);
  }
  if (counts.size === 0 || (counts.size === 1 && counts.has("by hand"))) return "";
  return [...counts].map(([words, count]) => (words === "by hand" || !/^[A-Z0-9]|^model/.test(words) ? `${count} ${words}` : `${count} from ${words}`)).join(", ");
}

/** Newest first, each with what it changed. */
export function readHistory(revisions: readonly AnnotationRevision[]): HistoryEntry[] {
  const poses = revisions.map(({ points, sources }) => (points ? fromWire(kept(points, sources)) : emptyPose()));
  return revisions.map(({ revision, author, created_at, points }, index) => {
    const pose = poses[index] ?? emptyPose();
    const before = poses[index + 1] ?? emptyPose();
    const changed = pose.flatMap((point, joint) => {
      const old = before[joint];
      return old && statusOf(old) === statusOf(point) && old.x === point.x && old.y === point.y ? [] : [joint];
    });
    const isNew = changed.every((joint) => statusOf(before[joint]) === "unset");
    const same = poses.findIndex((other, at) => at > index + 1 && samePose(other, pose));
    return { revision, author: author ?? "somebody", at: created_at, pose, isDeleted: points === null, changed, isNew, sameAs: revisions[same]?.revision ?? null };
  });
}
