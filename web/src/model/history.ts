/** The revisions of a hand as a person reads them. */

import type { AnnotationRevision } from "../api/types";
import { emptyPose, fromWire, samePose, statusOf, type Pose } from "./pose";

export interface HistoryEntry {
  readonly revision: number;
  readonly author: string;
  readonly at: string;
  readonly pose: Pose;
  readonly isDeleted: boolean;
  /** "index tip moved", "3 joints changed" */
  readonly changed: readonly number[];
  /** An earlier revision that was just like this one. */
  readonly sameAs: number | null;
}

/** Newest first, each with what it changed. */
export function readHistory(revisions: readonly AnnotationRevision[]): HistoryEntry[] {
  const poses = revisions.map(({ points }) => (points ? fromWire(points) : emptyPose()));
  return revisions.map(({ revision, author, created_at, points }, index) => {
    const pose = poses[index] ?? emptyPose();
    const before = poses[index + 1] ?? emptyPose();
    const changed = pose.flatMap((point, joint) => {
      const old = before[joint];
      return old && statusOf(old) === statusOf(point) && old.x === point.x && old.y === point.y ? [] : [joint];
    });
    const same = poses.findIndex((other, at) => at > index + 1 && samePose(other, pose));
    return { revision, author: author ?? "somebody", at: created_at, pose, isDeleted: points === null, changed, sameAs: revisions[same]?.revision ?? null };
  });
}
