import { Button, Stack, Text, Title } from "@mantine/core";
import { Link } from "react-router";
import { assignmentAddress, useAssignments, useComments, useMe, type Assignment, type AssignmentState } from "../../api/teams";
import { hasRole, toReview } from "../../model/assignment";
import { formatCount } from "../../model/format";
import { Awaited } from "../parts/Awaited";
import classes from "./projects.module.css";
import { StateBadge } from "./StateBadge";
import { WorkProgress, workText } from "../parts/WorkProgress";

/** Somebody waits for what came back and for what is to be reviewed. */
const ORDER: readonly AssignmentState[] = ["returned", "submitted", "open"];

interface Item {
  readonly assignment: Assignment;
  readonly isReview: boolean;
}

/** What is mine to do: to mark, to change because it was returned, to review; with its state and the way straight there. */
export function MyWork() {
  const me = useMe().data;
  const isReviewer = hasRole(me, "reviewer");
  const given = useAssignments({ mine: "true" });
  const waiting = useAssignments({ state: "submitted" }, isReviewer);
  const [mine, submitted] = [given.data, waiting.data];
  const isLoading = !mine || !me || (isReviewer && !submitted);
  const reviews = toReview(submitted ?? [], mine ?? [], me);
  const own = (mine ?? []).filter((one) => one.state !== "accepted" && !reviews.some((review) => review.id === one.id));
  const isMyTurn = ({ assignment, isReview }: Item): boolean => isReview || assignment.state !== "submitted";
  const items: Item[] = [...reviews.map((assignment) => ({ assignment, isReview: true })), ...own.map((assignment) => ({ assignment, isReview: false }))].sort(
    (a, b) => Number(isMyTurn(b)) - Number(isMyTurn(a)) || ORDER.indexOf(a.assignment.state) - ORDER.indexOf(b.assignment.state),
  );
  return (
    <Stack component="section" gap="sm" mb="xl" aria-label="My work">
      <Title order={2}>My work</Title>
      {isLoading && <Awaited what="Your work" query={{ error: given.error ?? waiting.error, refetch: () => void Promise.all([given.refetch(), waiting.refetch()]) }} height={64} />}
      {!isLoading && items.length === 0 && (
        <Text className="quiet">
          {isReviewer
            ? "Nothing waits for your review, and nothing is assigned to you. Work that somebody submits appears here."
            : "Nothing is assigned to you. What a lead assigns to you appears here, with the next frame to do."}
        </Text>
      )}
      {!isLoading && items.map((item) => <Work key={item.assignment.id} {...item} />)}
    </Stack>
  );
}

function Work({ assignment, isReview }: Item) {
  const isReturned = assignment.state === "returned";
  const why = useComments(assignment.id, isReturned).data?.filter((comment) => comment.resolved_at === null).at(-1);
  const isToDo = isReview || assignment.state !== "submitted";
  const label = isReview ? "Review it" : !isToDo ? "Look at it" : assignment.next_frame === null ? "Look through and submit" : `Go on at frame ${assignment.next_frame}`;
  return (
    <div className={`card ${classes.work}`} data-testid="work">
      <StateBadge state={assignment.state} />
      <div className={classes.words}>
        <Text fw={600} className="one-line">
          {assignment.recording}, {assignment.replica_set ? `${assignment.replica_set} (blind)` : `frames ${assignment.frame_first}–${assignment.frame_last}`}
        </Text>
        <Text size="xs" className="quiet one-line">
          {isReview && `${assignment.account} · `}
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
      <Button size="xs" miw={136} variant={isToDo ? "filled" : "default"} component={Link} to={assignmentAddress(assignment, isReview ? assignment.frame_first : (why?.frame ?? assignment.next_frame))}>
        {label}
      </Button>
    </div>
  );
}
