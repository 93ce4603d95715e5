import { Button, Skeleton, Stack, Text, Title } from "@mantine/core";
import { Link } from "react-router";
import { assignmentAddress, useAssignments, useComments, type Assignment, type AssignmentState } from "../../api/teams";
import { formatCount } from "../../model/format";
import classes from "./projects.module.css";
import { StateBadge } from "./StateBadge";
import { WorkProgress, workText } from "../parts/WorkProgress";

/** What came back goes first: somebody waits for it. */
const ORDER: readonly AssignmentState[] = ["returned", "open", "submitted"];

/** What is assigned to me, what was returned and why, and the next frame to do. */
export function MyWork() {
  const { data } = useAssignments({ mine: "true" });
  const mine = data?.filter((one) => one.state !== "accepted").sort((a, b) => ORDER.indexOf(a.state) - ORDER.indexOf(b.state));
  return (
    <Stack component="section" gap="sm" mb="xl" aria-label="My work">
      <Title order={2}>My work</Title>
      {!mine && <Skeleton height={64} radius="lg" />}
      {mine?.length === 0 && <Text className="quiet">Nothing is assigned to you. What a lead gives you to mark appears here, with the next frame to do.</Text>}
      {mine?.map((assignment) => (
        <Work key={assignment.id} assignment={assignment} />
      ))}
    </Stack>
  );
}

function Work({ assignment }: { assignment: Assignment }) {
  const isReturned = assignment.state === "returned";
  const why = useComments(assignment.id, isReturned).data?.filter((comment) => comment.resolved_at === null).at(-1);
  const isToDo = assignment.state !== "submitted";
  return (
    <div className={`card ${classes.work}`} data-testid="work">
      <StateBadge state={assignment.state} />
      <div className={classes.words}>
        <Text fw={600} className="one-line">
          {assignment.recording}, {assignment.replica_set ? `${assignment.replica_set} (blind)` : `frames ${assignment.frame_first}–${assignment.frame_last}`}
        </Text>
        <Text size="xs" className="quiet one-line">
          {assignment.project}
          {assignment.note && ` · ${assignment.note}`}
        </Text>
        {isReturned && why && (
          <Text size="sm" c="var(--warn-text)" mt={4} style={{ overflowWrap: "anywhere" }}>
            {why.author ?? "A reviewer"}: {why.text}
            {assignment.open_comments > 1 && ` (and ${formatCount(assignment.open_comments - 1, "more comment")})`}
          </Text>
        )}
      </div>
      <div className={classes.progress}>
        <WorkProgress done={assignment.frames_done} partial={assignment.frames_partial} total={assignment.frames} />
        <Text size="xs" className="quiet" mt={4}>
          {workText(assignment.frames_done, assignment.frames_partial, assignment.frames)}
        </Text>
      </div>
      <Button size="xs" miw={136} variant={isToDo ? "filled" : "default"} component={Link} to={assignmentAddress(assignment, why?.frame ?? assignment.next_frame)}>
        {isToDo ? (assignment.next_frame === null ? "Look through and submit" : `Go on at frame ${assignment.next_frame}`) : "Look at it"}
      </Button>
    </div>
  );
}
