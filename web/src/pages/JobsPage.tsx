import { Stack, Title } from "@mantine/core";
import { IconBriefcase } from "@tabler/icons-react";
import { Skeleton, Button } from "@mantine/core";
import { Link } from "react-router";
import { isActive, useJobs } from "../api/jobs";
import { useRecordings } from "../api/recordings";
import { EmptyState } from "./parts/EmptyState";
import { Failure } from "./parts/Failure";
import { JobRow } from "./parts/JobRow";
import { useTitle } from "./parts/useTitle";

export function JobsPage() {
  useTitle("Jobs");
  const { data, error, refetch } = useJobs();
  const recordings = useRecordings().data;
  const nameOf = (id: string | null): string | undefined => recordings?.find((recording) => recording.id === id)?.name;
  if (error && !data) {
    return <Failure what="The jobs could not be loaded" error={error} safe="Running jobs go on by themselves." onRetry={() => void refetch()} />;
  }
  if (data?.length === 0) {
    return (
      <EmptyState
        icon={<IconBriefcase size={48} stroke={1.25} />}
        title="No jobs yet"
        action={
          <Button component={Link} to="/recordings">
            Choose a recording
          </Button>
        }
      >
        Open a recording and start tracking. The job appears here with its progress, its log and what it made; it goes on when you close the browser.
      </EmptyState>
    );
  }
  const active = data?.filter(isActive) ?? [];
  const ended = data?.filter((job) => !isActive(job)) ?? [];
  return (
    <div className="page">
      <Title order={1} mb="lg">
        Jobs
      </Title>
      {!data && (
        <Stack gap="sm">
          {Array.from({ length: 5 }, (_, index) => (
            <Skeleton key={index} height={72} radius="lg" />
          ))}
        </Stack>
      )}
      {active.length > 0 && (
        <Stack gap="sm" mb="xl" component="section" aria-label="Waiting and running">
          <Title order={2}>Waiting and running</Title>
          {active.map((job) => (
            <JobRow key={job.id} job={job} recording={nameOf(job.sequence_id)} />
          ))}
        </Stack>
      )}
      {ended.length > 0 && (
        <Stack gap="sm" component="section" aria-label="Ended">
          <Title order={2}>Ended</Title>
          {ended.map((job) => (
            <JobRow key={job.id} job={job} recording={nameOf(job.sequence_id)} />
          ))}
        </Stack>
      )}
    </div>
  );
}
