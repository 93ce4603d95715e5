import { Group, Progress, Stack, Text } from "@mantine/core";
import { Link } from "react-router";
import { useRestartCheck } from "../../api/jobChecks";
import { isActive } from "../../api/jobs";
import type { Job } from "../../api/types";
import { Restart } from "../jobs/Restart";
import { JobActions, JobBadge, jobProgress } from "../parts/JobRow";
import classes from "./calibrations.module.css";

/** The job that calibrates: how far it is, or why it ended, and what can be done about it. */
export function Working({ job }: { job: Job }) {
  const restart = useRestartCheck(job).data;
  return (
    <>
      <Stack gap="sm" className={`card ${classes.card}`} mb="md" component="section" aria-label="The job">
        <Group justify="space-between">
          <Group gap="md">
            <JobBadge state={job.state} />
            <Link to={`/jobs/${job.id}`} className={classes.link}>
              To the job and its log
            </Link>
          </Group>
          <JobActions job={job} restart={restart} isHere />
        </Group>
        {isActive(job) && (
          <>
            <Group justify="space-between" role="status" aria-live="polite">
              <Text>{jobProgress(job)}</Text>
              <Text fw={600}>{Math.round(100 * job.progress)} %</Text>
            </Group>
            <Progress value={100 * job.progress} size="lg" animated={job.state === "running"} aria-label="Part done" />
          </>
        )}
        {job.error && (
          <Text c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
            {job.error} The films are kept: mend what is described below and check again, or send others.
          </Text>
        )}
      </Stack>
      {(job.state === "failed" || job.state === "cancelled") && <Restart job={job} check={restart} />}
    </>
  );
}
