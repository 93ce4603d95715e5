import { Group, Progress, Text } from "@mantine/core";
import { Link } from "react-router";
import { isActive } from "../../api/jobs";
import type { Job } from "../../api/types";
import { JobActions, JobBadge, jobProgress } from "../parts/JobRow";
import classes from "./Moving.module.css";

/** A job that registers this moving scan: how far it is, or why it ended, and what can be done about it. */
export function MovingJob({ job }: { job: Job }) {
  return (
    <section className={classes.job} aria-label="The job">
      <Group justify="space-between" gap="sm" wrap="nowrap">
        <Group gap="sm" wrap="nowrap">
          <JobBadge state={job.state} />
          <Link to={`/jobs/${job.id}`} className={classes.link}>
            <Text size="xs">Job and log</Text>
          </Link>
        </Group>
        <JobActions job={job} isHere />
      </Group>
      {isActive(job) && (
        <>
          <Group justify="space-between" gap="sm" wrap="nowrap" role="status" aria-live="polite">
            <Text size="xs">{jobProgress(job)}</Text>
            <Text size="xs" fw={600}>
              {Math.round(100 * job.progress)} %
            </Text>
          </Group>
          <Progress value={100 * job.progress} animated={job.state === "running"} aria-label="Part done" />
        </>
      )}
      {job.error && (
        <Text size="xs" c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
          {job.error} The frames that are registered are kept.
        </Text>
      )}
    </section>
  );
}
