/** What an assignment means for the frame one is at; no React, no network. */

import type { Assignment, Me, ReplicaSet } from "../api/teams";
import type { AnnotatorState } from "../state/annotator";
import { JOINT_COUNT } from "./joints";
import { decidedCount, parseKey } from "./pose";

const ROLES = ["annotator", "reviewer", "lead", "admin"] as const;

/** Whether somebody may do what this role may. */
export const hasRole = (me: Me | undefined, role: (typeof ROLES)[number]): boolean => me !== undefined && ROLES.indexOf(me.role) >= ROLES.indexOf(role);

/** Of a recording's assignments the one that a frame belongs to. */
export const assignmentAt = (assignments: readonly Assignment[], frame: number): Assignment | undefined =>
  assignments.find((one) => one.replica_set_id === null && one.frame_first <= frame && frame <= one.frame_last);

/** My own blind work that has this frame, while it is not accepted. */
export const blindAt = (assignments: readonly Assignment[], me: Me | undefined, frame: number): Assignment | undefined =>
  assignments.find((one) => one.replica_set_id !== null && one.account_id === me?.id && one.state !== "accepted" && one.frame_first <= frame && frame <= one.frame_last);

/** The frames that are asked for, in order. */
function framesOf({ frame_first: first, frame_last: last }: Assignment, replicas: ReplicaSet | undefined): readonly number[] {
  return replicas?.frames ?? Array.from({ length: last - first + 1 }, (_, index) => first + index);
}

/** Frames of work that was handed in. */
export const submittedFrames = (assignments: readonly Assignment[], replicas: ReplicaSet | undefined): number[] =>
  assignments.filter(({ state }) => state === "submitted" || state === "accepted").flatMap((one) => framesOf(one, replicas));

/** How far an assignment is. */
export interface AssignmentProgress {
  /** Frames in which every joint asked for is decided: placed, or said to be outside. */
  readonly done: number;
  readonly total: number;
  /** The first frame that is not done. */
  readonly next: number | null;
  /** Frames that were begun and are not done. */
  readonly partial: readonly number[];
}

/**
 * As it is here, before the server has counted: of a range each hand of the recording in one camera at least, and
 * nothing begun may stay half done; of a replica set every hand in every camera.
 */
export function progressOf(assignment: Assignment, replicas: ReplicaSet | undefined, poses: AnnotatorState["poses"], hands: readonly string[]): AssignmentProgress {
  const whole = new Map<number, Set<string>>();
  const begun = new Set<number>();
  const isHalf = new Set<number>();
  for (const [text, pose] of Object.entries(poses)) {
    const { frame, hand, camera } = parseKey(text);
    const decided = decidedCount(pose);
    if (decided === 0) continue;
    begun.add(frame);
    if (decided < JOINT_COUNT) isHalf.add(frame);
    else whole.set(frame, (whole.get(frame) ?? new Set()).add(replicas ? `${hand}|${camera}` : hand));
  }
  const needed = replicas ? replicas.cameras.length * replicas.hands.length : hands.length || 1;
  const frames = framesOf(assignment, replicas);
  const open = frames.filter((frame) => (whole.get(frame)?.size ?? 0) < needed || isHalf.has(frame));
  return { done: frames.length - open.length, total: frames.length, next: open[0] ?? null, partial: open.filter((frame) => begun.has(frame)) };
}

/** What is missing for work to be submitted, in words; empty when nothing is. */
export function describeUnfinished({ done, total, partial }: AssignmentProgress): string {
  const frames = (count: number, one: string, more: string): string => (count === 1 ? `1 frame ${one}` : `${count} frames ${more}`);
  const untouched = total - done - partial.length;
  const parts = [
    untouched > 0 ? `${frames(untouched, "is", "are")} not begun.` : "",
    partial.length > 0 ? `${frames(partial.length, "has", "have")} open joints, the first is ${partial[0]}.` : "",
  ];
  return parts.filter(Boolean).join(" ");
}

/** Of submitted work what this person may review: not their own (but a lead may), and no set that they mark blindly themselves. */
export function toReview(submitted: readonly Assignment[], mine: readonly Assignment[], me: Me | undefined): readonly Assignment[] {
  if (!hasRole(me, "reviewer")) return [];
  const blind = new Set(mine.filter((one) => one.replica_set_id !== null && one.state !== "accepted").map((one) => one.replica_set_id));
  return submitted.filter((one) => one.state === "submitted" && (one.account_id !== me?.id || hasRole(me, "lead")) && !blind.has(one.replica_set_id));
}

/** Why nothing may be changed at this frame, in words, or null. The server refuses the same. */
export function lockReason(assignment: Assignment | undefined, me: Me | undefined, replicas: ReplicaSet | undefined, hand: string): string | null {
  if (!assignment || !me) return null;
  const isMine = assignment.account_id === me.id;
  if (assignment.replica_set_id !== null) {
    if (!isMine) return `The blind work of ${assignment.account}: to be looked at, not changed`;
    if (assignment.state === "submitted" || assignment.state === "accepted") return `You have submitted this; a reviewer can return it`;
    if (replicas && !replicas.hands.some((one) => one === hand)) return `The ${hand} hand is not asked for here`;
    return null;
  }
  if (assignment.state === "accepted") return "This frame is finished: accepted, and locked until a reviewer returns it";
  if (hasRole(me, "reviewer")) return null;
  if (assignment.state === "submitted") return "This frame was submitted and waits for its review";
  return isMine ? null : `This frame is assigned to ${assignment.account}`;
}
