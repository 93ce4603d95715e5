import { Badge, Button, Group, Progress, Text } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconBan, IconCheck, IconClock, IconPlayerPlay, IconX } from "@tabler/icons-react";
import { Link } from "react-router";
import type { RestartCheck } from "../../api/jobChecks";
import { isActive, useJobAction } from "../../api/jobs";
import type { Job, JobState } from "../../api/types";
import { formatAgo, formatDuration, formatJobKind, formatLeft } from "../../model/format";
import classes from "./JobRow.module.css";
import { For } from "./For";

const STATES: Record<JobState, { color: string; icon: typeof IconCheck; label: string }> = {
  queued: { color: "gray", icon: IconClock, label: "waiting" },
  running: { color: "teal", icon: IconPlayerPlay, label: "running" },
  succeeded: { color: "teal", icon: IconCheck, label: "done" },
  failed: { color: "red", icon: IconX, label: "failed" },
  cancelled: { color: "gray", icon: IconBan, label: "cancelled" },
};

export function JobBadge({ state }: { state: JobState }) {
  const { color, icon: Icon, label } = STATES[state];
  return (
    <Badge variant={state === "running" ? "filled" : "light"} color={color} leftSection={<Icon size={12} aria-hidden />} tt="none" miw={96}>
      {label}
    </Badge>
  );
}

/** A stage may hold the name of a scan, which stays as it is. */
const capitalize = (text: string): string => text.replace(/^./, (letter) => letter.toUpperCase());

/** "tracking, 40 of 200 frames, 1:20 left". */
export function jobProgress(job: Job): string {
  const parts = [];
  if (job.stage && isActive(job)) parts.push(capitalize(job.stage));
  if (job.frames_total) parts.push(`${job.frames_done ?? 0} of ${job.frames_total} ${job.unit}`);
  if (job.state === "running" && job.seconds_left !== null) parts.push(formatLeft(job.seconds_left));
  if (job.state === "queued") parts.push("a worker takes it as soon as one is free");
  return parts.join(" · ");
}

const tookOf = (job: Job): string =>
  job.started_at && job.ended_at ? ` in ${formatDuration((Date.parse(job.ended_at) - Date.parse(job.started_at)) / 1000)}` : "";

const sayWhy = (failure: Error): void => void notifications.show({ color: "red", title: "Not done", message: failure.message });

/** Resume is offered where there is something to go on from; a list, which does not ask what is kept, goes by what was counted. */
const hasKept = (job: Job, restart: RestartCheck | undefined): boolean => (restart ? restart.kept.length > 0 : job.frames_done > 0);

/** What can be done with a job; `restart` says of one that ended whether it can go on or be tried again. `isHere`: on the page of what it makes. */
export function JobActions({ job, restart, isHere = false }: { job: Job; restart?: RestartCheck | undefined; isHere?: boolean }) {
  const cancel = useJobAction("cancel");
  const retry = useJobAction("retry");
  const resume = useJobAction("resume");
  return (
    <Group gap="sm" wrap="nowrap">
      {job.track_id && (
        <Button size="xs" component={Link} to={`/tracks/${job.track_id}`}>
          Open the track
        </Button>
      )}
      {job.kind === "detect" && job.state === "succeeded" && (
        <Button size="xs" component={Link} to={`/recordings/${job.sequence_id}/annotate`}>
          Annotate
        </Button>
      )}
      {job.kind === "calibrate" && !isHere && (
        <Button size="xs" variant={isActive(job) ? "default" : "filled"} component={Link} to={`/calibrations/${String(job.params["calibration_id"])}`}>
          Open the calibration
        </Button>
      )}
      {job.moving_scan_id && !isHere && (
        <Button size="xs" variant={isActive(job) ? "default" : "filled"} component={Link} to={`/scans/moving/${job.moving_scan_id}?job=${job.id}`}>
          Open the moving scan
        </Button>
      )}
      {job.hand_model_id && (
        <Button size="xs" variant={isActive(job) ? "default" : "filled"} component={Link} to={`/models/${job.hand_model_id}`}>
          Open the model
        </Button>
      )}
      {job.kind === "register" && job.frames_done > 0 && (
        <Button size="xs" variant={isActive(job) ? "default" : "filled"} component={Link} to="/curate">
          Curate
        </Button>
      )}
      <For role="reviewer">
        {isActive(job) && (
          <Button size="xs" variant="default" loading={cancel.isPending} onClick={() => cancel.mutate(job.id, { onError: sayWhy })}>
            Cancel
          </Button>
        )}
        {(job.state === "failed" || job.state === "cancelled") && hasKept(job, restart) && (
          <Button size="xs" variant="default" loading={resume.isPending} disabled={restart?.resume.can_start === false} onClick={() => resume.mutate(job.id, { onError: sayWhy })}>
            Resume
          </Button>
        )}
        {(job.state === "failed" || job.state === "cancelled") && (
          <Button size="xs" variant="default" loading={retry.isPending} disabled={restart?.retry.can_start === false} onClick={() => retry.mutate(job.id, { onError: sayWhy })}>
            Try again
          </Button>
        )}
      </For>
    </Group>
  );
}

export function JobRow({ job, recording }: { job: Job; recording: string | undefined }) {
  return (
    <div className={`card ${classes.row}`}>
      <JobBadge state={job.state} />
      <Link to={`/jobs/${job.id}`} className={classes.link}>
        <Text fw={600} className="one-line">
          {formatJobKind(job.kind)} {recording ?? "a recording"}
        </Text>
        <Text size="xs" className={job.error ? "one-line" : "quiet one-line"} c={job.error ? "var(--bad-text)" : undefined}>
          {job.error ?? (isActive(job) ? jobProgress(job) : `ended ${formatAgo(job.ended_at ?? job.created_at)}${tookOf(job)}`)}
          {job.state === "running" && job.worker ? ` · ${job.worker.name}` : ""}
          {job.created_by_name ? ` · ${job.created_by_name}` : ""}
        </Text>
      </Link>
      {isActive(job) && (
        <Progress value={100 * job.progress} w={200} animated={job.state === "running"} aria-label={`${Math.round(100 * job.progress)} % done`} />
      )}
      <JobActions job={job} />
    </div>
  );
}
