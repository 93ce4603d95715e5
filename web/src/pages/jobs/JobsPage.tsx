import { Button, Checkbox, Group, Skeleton, Stack, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconBriefcase, IconFilterOff } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import { useJobList } from "../../api/jobs";
import { Batches } from "./Batches";
import { JobFilterBar } from "./JobFilterBar";
import { SelectionBar } from "./SelectionBar";
import { StartBatch } from "./StartBatch";
import { useJobAddress } from "./useJobAddress";
import { Workers } from "./Workers";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { JobRow } from "../parts/JobRow";
import { useTitle } from "../parts/useTitle";
import { For } from "../parts/For";

/** Queue and workers, live; batches; every job there was, to be found, chosen and acted on. */
export function JobsPage() {
  useTitle("Jobs");
  const [filters, setFilters] = useJobAddress();
  const { data, error, refetch, fetchNextPage, hasNextPage, isFetchingNextPage } = useJobList(filters);
  const [chosen, setChosen] = useState<ReadonlySet<string>>(new Set());
  const [isStarting, starting] = useDisclosure(false);
  const jobs = data?.pages.flatMap((page) => page.items) ?? [];
  const isNarrowed = Boolean(filters.states.length > 0 || filters.recording || filters.person || filters.batch || filters.search);
  const selected = jobs.filter((job) => chosen.has(job.id));
  const choose = (id: string, isChosen: boolean): void => {
    const next = new Set(chosen);
    if (isChosen) next.add(id);
    else next.delete(id);
    setChosen(next);
  };

  if (error && !data) {
    return <Failure what="The jobs could not be loaded" error={error} safe="Running jobs continue." onRetry={() => void refetch()} />;
  }
  return (
    <div className="page">
      <Group mb="lg" justify="space-between">
        <Title order={1}>Jobs</Title>
        <For role="reviewer">
          <Button onClick={starting.open}>Track several …</Button>
        </For>
      </Group>
      <Stack gap="xl">
        <Workers />
        <Batches chosen={filters.batch} onChoose={(batch) => setFilters({ batch })} />
        <Stack gap="sm" component="section" aria-label="All jobs">
          <Title order={2}>{filters.batch ? "Jobs of the batch" : "All jobs"}</Title>
          <JobFilterBar filters={filters} jobs={jobs} onChange={setFilters} />
          {selected.length > 0 && <SelectionBar jobs={selected} onClear={() => setChosen(new Set())} />}
          {!data && Array.from({ length: 5 }, (_, index) => <Skeleton key={index} height={72} radius="lg" />)}
          {data && jobs.length === 0 && isNarrowed && (
            <EmptyState icon={<IconFilterOff size={40} stroke={1.25} />} title="No job matches">
              Change the filters above, or show all.
            </EmptyState>
          )}
          {data && jobs.length === 0 && !isNarrowed && (
            <EmptyState
              icon={<IconBriefcase size={48} stroke={1.25} />}
              title="No jobs yet"
              action={
                <Button component={Link} to="/recordings">
                  Choose a recording
                </Button>
              }
            >
              Open a recording and start tracking, or track several at once. Jobs appear here with their progress, their log and what they made; they go on when you
              close the browser.
            </EmptyState>
          )}
          {jobs.map((job) => (
            <Group key={job.id} gap="sm" wrap="nowrap">
              <Checkbox aria-label={`Choose the job of ${job.title}`} checked={chosen.has(job.id)} onChange={(event) => choose(job.id, event.currentTarget.checked)} />
              <div style={{ flex: 1, minWidth: 0 }}>
                <JobRow job={job} recording={job.title} />
              </div>
            </Group>
          ))}
          {hasNextPage && (
            <Button variant="default" loading={isFetchingNextPage} onClick={() => void fetchNextPage()} style={{ alignSelf: "center" }}>
              Show older jobs
            </Button>
          )}
        </Stack>
      </Stack>
      <StartBatch isOpen={isStarting} onClose={starting.close} onStarted={(batch) => setFilters({ states: [], recording: undefined, person: undefined, search: undefined, batch })} />
    </div>
  );
}
