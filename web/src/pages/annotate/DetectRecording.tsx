import { Button, Group, Progress, Stack, Text } from "@mantine/core";
import { isActive, useRecordingJobs } from "../../api/jobs";
import { useStartJob } from "../../api/startJob";
import type { Job } from "../../api/types";
import { formatAgo } from "../../model/format";
import { For } from "../parts/For";
import { JobActions, jobProgress } from "../parts/JobRow";
import classes from "./DetectRecording.module.css";

interface DetectJobs {
  /** Whether the server has said which there are. */
  readonly isKnown: boolean;
  /** The last one that was started. */
  readonly last: Job | undefined;
  /** The last one that ended well: it suggests. */
  readonly found: Job | undefined;
  readonly error: Error | null;
}

/** The jobs of the hand detector for a recording. */
export function useDetectJobs(recording: string): DetectJobs {
  const { data, error } = useRecordingJobs(recording);
  const jobs = (data ?? []).filter((job) => job.kind === "detect");
  return { isKnown: data !== undefined || error !== null, last: jobs[0], found: jobs.find((job) => job.state === "succeeded"), error };
}

/** Have the hand detector look through the whole recording: where that stands, and what one can do about it. */
export function DetectRecording({ recording, jobs: { last, found, error } }: { recording: string; jobs: DetectJobs }) {
  const start = useStartJob();
  const isWaiting = last !== undefined && isActive(last);
  const hasStopped = last?.state === "failed" || last?.state === "cancelled";
  return (
    <Stack gap={8} className={classes.box} role="group" aria-label="Hand detector, whole recording">
      <Text size="xs" className="quiet" role="status">
        {error && !last
          ? `Whether the recording was looked through is not known: ${error.message}`
          : found
            ? `The detector looked through the whole recording ${formatAgo(found.ended_at ?? found.created_at)}.`
            : "The detector looks at each image by itself. In a pass through the whole recording it follows the hands and finds more of them."}
      </Text>
      {isWaiting && (
        <>
          <Progress value={100 * last.progress} size="sm" animated={last.state === "running"} color="violet" aria-label={`${Math.round(100 * last.progress)} % looked through`} />
          <Text size="xs">{jobProgress(last)}</Text>
        </>
      )}
      {hasStopped && (
        <Text size="xs" c={last.error ? "var(--bad-text)" : undefined} className={classes.reason}>
          {last.error ? `It stopped: ${last.error}` : "It was cancelled; what was looked at is kept."}
        </Text>
      )}
      {start.error && (
        <Text size="xs" c="var(--bad-text)" role="alert">
          {start.error.message} Nothing was started.
        </Text>
      )}
      {isWaiting || hasStopped ? (
        <JobActions job={last} />
      ) : (
        <For role="reviewer">
          <Group>
            <Button size="compact-xs" variant="light" color="violet" loading={start.isPending} onClick={() => start.mutate({ kind: "detect", sequence_id: recording })}>
              {found ? "Look through it again" : "Look through the whole recording"}
            </Button>
          </Group>
        </For>
      )}
    </Stack>
  );
}
