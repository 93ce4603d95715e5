import { useMemo } from "react";
import { useAssignment, useAssignments, useMe, useReplicaSet, type Assignment, type Me, type ReplicaSet } from "../../api/teams";
import { assignmentAt, blindAt, submittedFrames } from "../../model/assignment";
import type { FrameMarks } from "../../model/frameMarks";
import { useAnnotating } from "./annotating";
import { useAnnotation } from "./reading";

interface Here {
  me: Me | undefined;
  /** The work that the frame one is at belongs to: the replica of the address, or the range around the frame. */
  assignment: Assignment | undefined;
  replicas: ReplicaSet | undefined;
  /** My own blind work that has this frame, when one is not in it. */
  blind: Assignment | undefined;
  failure: Error | null;
}

/** Frames that were handed in: they wait for their review, or are finished. */
export function useSubmittedMarks(): FrameMarks {
  const { recording, replica } = useAnnotating();
  const all = useAssignments({ sequence: recording.get().id }).data;
  const own = useAssignment(replica).data;
  const replicas = useReplicaSet(own?.replica_set_id).data;
  return useMemo(() => ({ submitted: new Set(submittedFrames(replica ? (own ? [own] : []) : (all ?? []).filter((one) => one.replica_set_id === null), replicas)) }), [replica, all, own, replicas]);
}

export function useAssignmentHere(): Here {
  const { recording, replica } = useAnnotating();
  const frame = useAnnotation((state) => state.frame);
  const me = useMe().data;
  const all = useAssignments({ sequence: recording.get().id }).data ?? [];
  const own = useAssignment(replica);
  const assignment = replica ? own.data : assignmentAt(all, frame);
  const blind = replica ? undefined : blindAt(all, me, frame);
  const replicas = useReplicaSet(assignment?.replica_set_id ?? blind?.replica_set_id).data;
  const isBlindHere = blind !== undefined && replicas !== undefined && replicas.frames.includes(frame);
  return { me, assignment, replicas, blind: isBlindHere ? blind : undefined, failure: own.error };
}
