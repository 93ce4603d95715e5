import { Button, Code, Group, Progress, ScrollArea, SimpleGrid, Stack, Text, Title } from "@mantine/core";
import { useEffect, useRef } from "react";
import { Link, useParams } from "react-router";
import { useRestartCheck } from "../../api/jobChecks";
import { isActive, useJob, useJobForm, useJobLog } from "../../api/jobs";
import { useRecording } from "../../api/recordings";
import { describeParams } from "../../model/compareJobs";
import { formatAgo, formatDuration, formatJobKind, formatName } from "../../model/format";
import { CompareWith } from "./CompareWith";
import { JobResult } from "./JobResult";
import { Restart } from "./Restart";
import { Failure } from "../parts/Failure";
import { JobActions, JobBadge, jobProgress } from "../parts/JobRow";
import { PageSkeleton } from "../parts/PageSkeleton";
import { Fact } from "../parts/Fact";
import { useTitle } from "../parts/useTitle";
import classes from "./JobPage.module.css";

function Log({ jobId, isLive }: { jobId: string; isLive: boolean }) {
  const { data, error } = useJobLog(jobId, isLive);
  const lines = useRef<HTMLDivElement>(null);
  const count = data?.length ?? 0;
  useEffect(() => void lines.current?.scrollTo({ top: lines.current.scrollHeight }), [count]);
  if (error) return <Text className="quiet">The log could not be loaded: {error.message}</Text>;
  return (
    <ScrollArea.Autosize mah={420} className={classes.log} viewportRef={lines} tabIndex={0} aria-label="Log of the job">
      {count === 0 && <Text className="quiet">{!data ? "Loading …" : isLive ? "Nothing logged yet." : "The job logged nothing."}</Text>}
      {data?.map((line) => (
        <div key={line.n} className={classes.line} data-level={line.level.toLowerCase()}>
          <span className="quiet">{new Date(line.time).toLocaleTimeString()}</span> <span className={classes.level}>{line.level.toLowerCase()}</span> {line.text}
        </div>
      ))}
    </ScrollArea.Autosize>
  );
}

export function JobPage() {
  const { jobId = "" } = useParams();
  const { data: job, error, refetch } = useJob(jobId);
  const recording = useRecording(job?.sequence_id ?? undefined).data;
  const restart = useRestartCheck(job).data;
  const form = useJobForm(job?.kind === "track").data;
  useTitle(job ? `${formatJobKind(job.kind)} ${job.title}` : "Job");
  if (error && !job)
    return (
      <Failure what="The job could not be loaded" error={error} safe="If it is running, it continues." onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/jobs">
          To the jobs
        </Button>
      </Failure>
    );
  if (!job) return <PageSkeleton />;
  const params = describeParams(job.params, form);
  return (
    <div className="page">
      <Group mb="lg" justify="space-between" wrap="nowrap" align="flex-start">
        <div style={{ minWidth: 0 }}>
          <Group gap="md" wrap="nowrap">
            <Title order={1} className="few-lines">
              {formatJobKind(job.kind)} {job.title}
            </Title>
            <JobBadge state={job.state} />
          </Group>
          {recording && (
            <Text size="sm" mt={4}>
              <Link to={`/recordings/${recording.id}`} className={classes.link}>
                To the recording
              </Link>
              {job.batch_id && (
                <>
                  {" · "}
                  <Link to={`/jobs?batch=${job.batch_id}`} className={classes.link}>
                    To its batch
                  </Link>
                </>
              )}
            </Text>
          )}
        </div>
        <Group gap="sm" wrap="nowrap">
          <CompareWith job={job} />
          <JobActions job={job} restart={restart} />
        </Group>
      </Group>
      {isActive(job) && (
        <Stack gap="sm" className="card" p="md" mb="md" role="status" aria-live="polite">
          <Group justify="space-between">
            <Text>{jobProgress(job)}</Text>
            <Text fw={600}>{Math.round(100 * job.progress)} %</Text>
          </Group>
          <Progress value={100 * job.progress} size="lg" animated={job.state === "running"} aria-label="Part done" />
        </Stack>
      )}
      {job.error && (
        <Stack gap={4} className="card" p="md" mb="md" role="alert" style={{ borderColor: "var(--bad)" }}>
          <Text fw={600} c="var(--bad-text)">
            The job failed
          </Text>
          <Text style={{ overflowWrap: "anywhere" }}>{job.error}</Text>
        </Stack>
      )}
      {(job.state === "failed" || job.state === "cancelled") && <Restart job={job} check={restart} />}
      <SimpleGrid cols={{ base: 2, sm: 6 }} spacing="md" mb="lg">
        <Fact label="Made">{formatAgo(job.created_at)}</Fact>
        <Fact label="Started">{job.started_at ? formatAgo(job.started_at) : "–"}</Fact>
        <Fact label="Took">
          {job.started_at && job.ended_at ? formatDuration((Date.parse(job.ended_at) - Date.parse(job.started_at)) / 1000) : "–"}
        </Fact>
        <Fact label="Started by">{job.created_by_name ?? "–"}</Fact>
        <Fact label={job.state === "running" ? "Runs on" : "Ran on"}>{job.worker ? job.worker.name : "–"}</Fact>
        {job.kind !== "train" && (
          <Fact label={formatName(job.unit)}>{job.frames_total ? `${job.frames_done ?? 0} of ${job.frames_total}` : "–"}</Fact>
        )}
      </SimpleGrid>
      {job.track_id && <JobResult trackId={job.track_id} />}
      <div className={classes.columns}>
        <section aria-label="Log">
          <Title order={2} mb="sm">
            Log
          </Title>
          <Log jobId={jobId} isLive={isActive(job)} />
        </section>
        <section aria-label="Parameters">
          <Title order={2} mb="sm">
            Parameters
          </Title>
          <Stack gap={4} className="card" p="md">
            {params.length === 0 && <Text className="quiet">All at their defaults.</Text>}
            {params.map(([label, value]) => (
              <Group key={label} justify="space-between" wrap="nowrap" align="flex-start">
                <Text size="sm" className="quiet">
                  {label}
                </Text>
                <Code className={classes.value}>{value}</Code>
              </Group>
            ))}
          </Stack>
        </section>
      </div>
    </div>
  );
}
