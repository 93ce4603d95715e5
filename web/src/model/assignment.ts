/** What an assignment means for the frame one is at; no React, no network. */

import type { Assignment, Me, ReplicaSet } from "../api/teams";
import type { AnnotatorState } from "../state/annotator";
import { parseKey, placedCount } from "./pose";

const ROLES = ["annotator", "reviewer", "lead", "admin"] as const;

/** Whether somebody may do what this role may. */
export const hasRole = (me: Me | undefined, role: (typeof ROLES)[number]): boolean => me !== undefined && ROLES.indexOf(me.role) >= ROLES.indexOf(role);

/** The frame of the set that stands in for a wanted one: the next in the direction of travel, else the last there is. */
export function snapFrame(frames: readonly number[], wanted: number, from: number): number {
  if (frames.includes(wanted)) return wanted;
  const next = wanted >= from ? frames.find((frame) => frame > wanted) : frames.findLast((frame) => frame < wanted);
  return next ?? (wanted >= from ? frames.at(-1) : frames[0]) ?? wanted;
}

/** Of a recording's assignments the one that a frame belongs to. */
export const assignmentAt = (assignments: readonly Assignment[], frame: number): Assignment | undefined =>
  assignments.find((one) => one.replica_set_id === null && one.frame_first <= frame && frame <= one.frame_last);

/** My own blind work that has this frame, while it is not accepted. */
export const blindAt = (assignments: readonly Assignment[], me: Me | undefined, frame: number): Assignment | undefined =>
  assignments.find((one) => one.replica_set_id !== null && one.account_id === me?.id && one.state !== "accepted" && one.frame_first <= frame && frame <= one.frame_last);

/** Frames that are done as they are here, and the first that is not: at once, before the server has counted. */
export function progressOf(assignment: Assignment, replicas: ReplicaSet | undefined, poses: AnnotatorState["poses"]): { done: number; total: number; next: number | null } {
  const marked = new Map<number, number>();
  for (const [text, pose] of Object.entries(poses)) {
    if (placedCount(pose) === 0) continue;
    const { frame } = parseKey(text);
    marked.set(frame, (marked.get(frame) ?? 0) + 1);
  }
  const needed = replicas ? replicas.cameras.length * replicas.hands.length : 1;
  const length = assignment.frame_last - assignment.frame_first + 1;
  const frames = replicas?.frames ?? Array.from({ length }, (_, index) => assignment.frame_first + index);
  const open = frames.filter((frame) => (marked.get(frame) ?? 0) < needed);
  return { done: frames.length - open.length, total: frames.length, next: open[0] ?? null };
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
