import { Button, CloseButton, Group, MultiSelect, Select, TextInput } from "@mantine/core";
import { IconSearch } from "@tabler/icons-react";
import type { JobFilters } from "../../api/jobs";
import { useRecordings } from "../../api/recordings";
import type { Job, JobState } from "../../api/types";
import { JOB_STATES } from "./useJobAddress";

const LABELS: Record<JobState, string> = { queued: "waiting", running: "running", succeeded: "done", failed: "failed", cancelled: "cancelled" };

interface JobFilterBarProps {
  filters: JobFilters;
  /** Those at hand; whoever started one of them can be chosen. */
  jobs: readonly Job[];
  onChange: (changes: Partial<JobFilters>) => void;
}

export function JobFilterBar({ filters, jobs, onChange }: JobFilterBarProps) {
  const recordings = useRecordings().data ?? [];
  const people = new Map(jobs.flatMap((job) => (job.created_by ? [[job.created_by, job.created_by_name ?? "somebody"] as const] : [])));
  if (filters.person && !people.has(filters.person)) people.set(filters.person, "the chosen person");
  const isNarrowed = filters.states.length > 0 || filters.recording || filters.person || filters.batch || filters.search;
  return (
    <Group gap="sm" role="search" aria-label="Filter jobs">
      <TextInput
        w={208}
        value={filters.search ?? ""}
        onChange={(event) => onChange({ search: event.currentTarget.value || undefined })}
        placeholder="Words of the recording"
        aria-label="Search jobs by recording"
        leftSection={<IconSearch size={16} aria-hidden />}
        rightSection={filters.search && <CloseButton size="sm" aria-label="Clear the search" onClick={() => onChange({ search: undefined })} />}
      />
      <MultiSelect
        w={248}
        aria-label="States"
        placeholder={filters.states.length === 0 ? "Any state" : undefined}
        data={JOB_STATES.map((state) => ({ value: state, label: LABELS[state] }))}
        value={filters.states}
        onChange={(states) => onChange({ states: states })}
        clearable
      />
      <Select
        w={200}
        aria-label="Recording"
        placeholder="Any recording"
        searchable
        clearable
        data={recordings.map((recording) => ({ value: recording.id, label: recording.name }))}
        value={filters.recording ?? null}
        onChange={(recording) => onChange({ recording: recording ?? undefined })}
      />
      <Select
        w={168}
        aria-label="Person"
        placeholder="Anybody"
        clearable
        data={[...people].map(([value, label]) => ({ value, label }))}
        value={filters.person ?? null}
        onChange={(person) => onChange({ person: person ?? undefined })}
      />
      {isNarrowed && (
        <Button variant="subtle" size="xs" onClick={() => onChange({ states: [], recording: undefined, person: undefined, batch: undefined, search: undefined })}>
          Show all
        </Button>
      )}
    </Group>
  );
}
