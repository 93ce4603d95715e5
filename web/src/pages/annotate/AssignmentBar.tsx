import { Button, Text, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconEyeOff, IconMessage } from "@tabler/icons-react";
import { useEffect, useMemo, useRef, useState } from "react";
import { Link } from "react-router";
import { goToFrame, keepToFrames, selectCamera } from "../../actions/annotate/select";
import { assignmentAddress, useTeamChange, type Assignment } from "../../api/teams";
import { describeUnfinished, hasRole, lockReason, progressOf } from "../../model/assignment";
import { jointLabel } from "../../model/joints";
import { useHint } from "../../state/keys";
import type { SaveStatus } from "../../state/saveQueue";
import { StateBadge } from "../projects/StateBadge";
import { WorkProgress } from "../parts/WorkProgress";
import { useActions, useAnnotating } from "./annotating";
import { useAnnotation, useOpenRecording, useSaving } from "./reading";
import classes from "./AssignmentBar.module.css";
import { useAssignmentHere } from "./useAssignmentHere";
import { Words } from "./Words";

type Writing = "comment" | "return";

const isStuck = ({ conflicts, refusals }: SaveStatus): boolean => conflicts.size > 0 || refusals.size > 0;

/** The work that this frame belongs to: how far it is, and what comes next. Draws nothing where nobody was given anything. */
export function AssignmentBar() {
  const { session, act, show } = useAnnotating();
  const { hands } = useOpenRecording();
  const [frame, camera, hand, joint] = [useAnnotation((state) => state.frame), useAnnotation((state) => state.camera), useAnnotation((state) => state.hand), useAnnotation((state) => state.joint)];
  const poses = useAnnotation((state) => state.poses);
  const saving = useSaving((now) => now);
  const { me, assignment, replicas, blind, failure } = useAssignmentHere();
  const change = useTeamChange<Assignment>();
  const hint = useHint();
  const [writing, setWriting] = useState<Writing | null>(null);
  const [isSure, setSure] = useState(false);
  const [isWaiting, setWaiting] = useState(false);

  const asked = assignment?.replica_set_id ? replicas : undefined;
  useEffect(() => {
    act(keepToFrames, asked?.frames ?? null);
  }, [asked, act]);
  useEffect(() => {
    const first = asked?.cameras[0];
    if (first && !asked.cameras.includes(camera)) act(selectCamera, first);
  }, [asked, camera, act]);

  const reason = blind ? "You are marking this frame blind: open your own version" : lockReason(assignment, me, replicas, hand);
  useEffect(() => {
    show({ lock: reason });
    return () => show({ lock: null });
  }, [reason, show]);
  useEffect(() => {
    setSure(false);
    setWaiting(false);
  }, [assignment?.id, frame]);

  const progress = useMemo(() => assignment && progressOf(assignment, replicas, poses, hands), [assignment, replicas, poses, hands]);
  const unfinished = progress ? describeUnfinished(progress) : "";
  const isMine = assignment !== undefined && assignment.account_id === me?.id;
  const isOpen = assignment?.state === "open" || assignment?.state === "returned";
  const maySubmit = isOpen && (isMine || hasRole(me, "lead"));
  const mayReview = hasRole(me, "reviewer") && (!isMine || hasRole(me, "lead"));
  const mayAccept = mayReview && assignment?.state === "submitted";
  const mayReturn = mayReview && (assignment?.state === "submitted" || assignment?.state === "accepted");
  const mayTalk = isMine || hasRole(me, "reviewer");

  /** What came of it is seen in the bar. */
  const send = (verb: string, body?: unknown): void => {
    if (!assignment) return;
    const sent = { method: "POST", path: `/assignments/${assignment.id}/${verb}`, ...(body === undefined ? {} : { body }) } as const;
    change.mutate(verb === "comments" ? sent : { ...sent, revision: assignment.revision }, {
      onSuccess: () => {
        // Live news of a comment may come before its answer: what the person opened since stays open.
        const written: Writing = verb === "comments" ? "comment" : "return";
        setWriting((now) => (now === written ? null : now));
        setSure(false);
      },
      onError: (error) => notifications.show({ color: "red", title: "That was not done", message: error.message }),
    });
  };
  const sendNow = useRef(send);
  sendNow.current = send;
  const submit = (): void => {
    if (!progress) return;
    if (isStuck(session.saving())) notifications.show({ color: "yellow", message: "Resolve the unsaved changes, then submit." });
    else if (unfinished !== "" && !isSure) setSure(true);
    else setWaiting(true);
  };
  // Work goes once the server has all of it: a key right after the last joint is not lost. The queue itself is asked,
  // because what is drawn here may be a moment old.
  useEffect(() => {
    const now = session.saving();
    if (!isWaiting || (!isStuck(now) && (now.waiting > 0 || now.isSending))) return;
    setWaiting(false);
    if (!isStuck(now)) sendNow.current("submit");
  }, [isWaiting, saving, session]);
  const goNext = (): void => {
    if (progress && progress.next !== null) act(goToFrame, progress.next);
  };
  // Always all of them: the page looks once which keys are answered, and who I am may be known later than that.
  useActions({
    "assignment.next": goNext,
    "assignment.submit": () => maySubmit && submit(),
    "assignment.accept": () => mayAccept && send("accept"),
    "assignment.return": () => mayReturn && setWriting("return"),
    "assignment.comment": () => assignment && mayTalk && setWriting("comment"),
  });

  if (failure) {
    return (
      <div className={classes.bar} role="alert">
        <Text size="sm">{failure.message}</Text>
        <Link to="/projects">To the projects</Link>
      </div>
    );
  }
  if (blind) {
    return (
      <div className={classes.bar}>
        <IconEyeOff size={16} aria-hidden />
        <Text size="sm">You mark this frame blindly; what others marked in it is hidden from you.</Text>
        <Button size="compact-xs" variant="default" component={Link} to={assignmentAddress(blind, frame)} reloadDocument>
          Open my version
        </Button>
      </div>
    );
  }
  if (!assignment || !progress) return null;
  return (
    <div className={classes.bar} role="group" aria-label="Assignment">
      <StateBadge state={assignment.state} />
      <Tooltip label={assignment.note || `Part of ${assignment.project}`} multiline maw={400}>
        <Link to={`/projects/${assignment.project_id}`} className={`${classes.name} one-line`}>
          {assignment.replica_set ? `${assignment.replica_set}, blind` : `Frames ${assignment.frame_first}–${assignment.frame_last}`}
          {!isMine && ` · ${assignment.account}`}
        </Link>
      </Tooltip>
      <WorkProgress done={progress.done} partial={progress.partial.length} total={progress.total} w={120} />
      <Text size="xs" className="quiet" style={{ whiteSpace: "nowrap" }} data-testid="assignment-progress">
        {progress.done} of {progress.total} done{progress.partial.length > 0 && `, ${progress.partial.length} begun`}
      </Text>
      {writing ? (
        <Words
          key={writing}
          label={writing === "return" ? "What should be changed" : `Comment on the ${hand} ${jointLabel(joint)}`}
          isBusy={change.isPending}
          onCancel={() => setWriting(null)}
          onSend={(text) =>
            writing === "return"
              ? send("return", { text })
              : send("comments", { text, camera, frame, hand, joint })
          }
          // To return work needs no words of its own where comments say what is to be changed.
          mayBeEmpty={writing === "return" && assignment.open_comments > 0}
        />
      ) : (
        <div className={classes.acts}>
          {isSure && !isWaiting && (
            <Text size="xs" c="var(--warn-text)" role="status">
              {unfinished}
            </Text>
          )}
          {isWaiting && (
            <Text size="xs" className="quiet" role="status">
              Submits as soon as everything is saved
            </Text>
          )}
          {assignment.open_comments > 0 && (
            <Text size="xs" className="quiet" style={{ whiteSpace: "nowrap" }}>
              {assignment.open_comments} to resolve
            </Text>
          )}
          {mayTalk && (
            <Tooltip label={hint("Comment on this joint", "assignment.comment")}>
              <Button size="compact-xs" variant="subtle" color="gray" leftSection={<IconMessage size={14} aria-hidden />} onClick={() => setWriting("comment")}>
                Comment
              </Button>
            </Tooltip>
          )}
          {isOpen && progress.next !== null && (
            <Tooltip label={hint("Next frame to do", "assignment.next")}>
              <Button size="compact-xs" variant="default" onClick={goNext}>
                Next: {progress.next}
              </Button>
            </Tooltip>
          )}
          {maySubmit && (
            <Tooltip label={hint("Submit the work; it is locked until it is reviewed", "assignment.submit")}>
              <Button size="compact-xs" variant={isMine ? "filled" : "default"} loading={change.isPending || isWaiting} onClick={submit}>
                {isSure ? "Submit anyway" : "Submit"}
              </Button>
            </Tooltip>
          )}
          {mayReturn && (
            <Tooltip label={hint("Send it back with the reason", "assignment.return")}>
              <Button size="compact-xs" variant="default" onClick={() => setWriting("return")}>
                Return
              </Button>
            </Tooltip>
          )}
          {mayAccept && (
            <Tooltip label={hint("Accept the work; it is locked from then on", "assignment.accept")}>
              <Button size="compact-xs" loading={change.isPending} onClick={() => send("accept")}>
                Accept
              </Button>
            </Tooltip>
          )}
        </div>
      )}
    </div>
  );
}
