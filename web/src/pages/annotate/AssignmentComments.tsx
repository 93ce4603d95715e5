import { Button, Group, Skeleton, Text } from "@mantine/core";
import { useComments, useTeamChange, type Comment } from "../../api/teams";
import { hasRole } from "../../model/assignment";
import { formatAgo } from "../../model/format";
import { jointLabel } from "../../model/joints";
import { useAnnotating } from "./annotating";
import classes from "./AssignmentBar.module.css";
import { useAssignmentHere } from "./useAssignmentHere";

const placeOf = (comment: Comment): string =>
  [comment.frame !== null && `frame ${comment.frame}`, comment.hand, comment.joint !== null && jointLabel(comment.joint)].filter(Boolean).join(", ");

/** What annotator and reviewers say to each other about this work; a click goes to the place. */
export function AssignmentComments() {
  const { session } = useAnnotating();
  const { me, assignment } = useAssignmentHere();
  const mayTalk = assignment !== undefined && (assignment.account_id === me?.id || hasRole(me, "reviewer"));
  const { data, error } = useComments(assignment?.id, mayTalk);
  const change = useTeamChange();

  const go = (comment: Comment): void => {
    if (comment.frame === null) return;
    const state = session.store.get();
    const { frame, camera, hand, joint } = comment;
    session.store.set({ ...state, frame, camera: camera ?? state.camera, hand: hand ?? state.hand, joint: joint ?? state.joint, isChosen: false, draft: null }, "person");
  };
  if (!assignment || !mayTalk) {
    return (
      <div className={classes.comments}>
        <Text size="xs" className="quiet">
          {assignment ? "Comments are between the annotator of this frame and the reviewers." : "This frame is not assigned. Leads assign work on a project's page; comments of reviewers appear here."}
        </Text>
      </div>
    );
  }
  return (
    <div className={classes.comments} aria-label="Comments" role="group">
      {error && (
        <Text size="xs" role="alert">
          {error.message}
        </Text>
      )}
      {!data && !error && [0, 1].map((index) => <Skeleton key={index} height={72} />)}
      {data?.length === 0 && (
        <Text size="xs" className="quiet">
          No comments yet. Choose a joint and press Comment to ask, or to say what should be changed.
        </Text>
      )}
      {data?.map((comment) => (
        <div key={comment.id} className={classes.comment} data-resolved={comment.resolved_at !== null}>
          <Text size="xs" className="quiet">
            {comment.author ?? "somebody"}, {formatAgo(comment.created_at)}
          </Text>
          <Text size="sm" my={4} style={{ overflowWrap: "anywhere", whiteSpace: "pre-wrap" }}>
            {comment.text}
          </Text>
          <Group gap={8}>
            {comment.frame !== null && (
              <Button size="compact-xs" variant="default" onClick={() => go(comment)}>
                {placeOf(comment)}
              </Button>
            )}
            <Button
              size="compact-xs"
              variant="subtle"
              onClick={() => change.mutate({ method: "POST", path: `/assignments/${assignment.id}/comments/${comment.id}/${comment.resolved_at ? "reopen" : "resolve"}` })}
            >
              {comment.resolved_at ? "Reopen" : "Resolve"}
            </Button>
          </Group>
          {comment.resolved_at && (
            <Text size="xs" className="quiet" mt={4}>
              resolved by {comment.resolved_by ?? "somebody"}
            </Text>
          )}
        </div>
      ))}
    </div>
  );
}
