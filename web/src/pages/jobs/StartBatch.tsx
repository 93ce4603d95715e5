import { Checkbox, Group, ScrollArea, Select, Stack, Text, TextInput } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { IconSearch } from "@tabler/icons-react";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { ApiError } from "../../api/client";
import { useBatchCheck } from "../../api/jobChecks";
import { useStartBatch } from "../../api/jobs";
import { fetchAll, useRecordings } from "../../api/recordings";
import type { components } from "../../api/schema";
import type { Recording } from "../../api/types";
import { formatCount } from "../../model/format";
import { Awaited } from "../parts/Awaited";
import { TrackingForm, useTrackingOptions } from "../parts/TrackingForm";
import classes from "./StartBatch.module.css";

type Project = components["schemas"]["ProjectOut"];
type ProjectRecording = components["schemas"]["ProjectRecording"];

interface Refusal {
  id: string;
  detail: string;
}

const refusalsOf = (error: unknown): Refusal[] => (error instanceof ApiError ? ((error.body["refused"] as Refusal[] | undefined) ?? []) : []);

interface StartBatchProps {
  isOpen: boolean;
  onClose: () => void;
  onStarted: (batch: string) => void;
}

/** One form for many recordings: all of them are started, or none. */
export function StartBatch({ isOpen, onClose, onStarted }: StartBatchProps) {
  const query = useRecordings();
  const recordings = query.data;
  const projects = useQuery({ queryKey: ["jobs", "projects"], queryFn: () => fetchAll<Project>("/projects"), enabled: isOpen }).data ?? [];
  const options = useTrackingOptions(isOpen);
  const start = useStartBatch();
  const ids = recordings?.map((recording) => recording.id) ?? [];
  const obstacles = useBatchCheck(ids, options.changed, isOpen).data;
  const isTrackable = (recording: Recording): boolean => obstacles !== undefined && !obstacles.has(recording.id);
  const [search, setSearch] = useState("");
  const [chosen, setChosen] = useState<ReadonlySet<string>>(new Set());

  const shown = recordings?.filter((recording) => recording.name.toLowerCase().includes(search.trim().toLowerCase())) ?? [];
  const selectable = shown.filter(isTrackable);
  const areAllChosen = selectable.length > 0 && selectable.every((recording) => chosen.has(recording.id));
  const choose = (ids: string[], isChosen: boolean): void => {
    const next = new Set(chosen);
    for (const id of ids) if (isChosen) next.add(id); else next.delete(id);
    setChosen(next);
  };
  const chooseProject = (project: string | null): void => {
    if (!project) return;
    void fetchAll<ProjectRecording>(`/projects/${project}/sequences`).then((found) => {
      const ids = new Set(found.map((one) => one.id));
      setSearch("");
      setChosen(new Set(recordings?.filter((recording) => ids.has(recording.id) && isTrackable(recording)).map((recording) => recording.id)));
    });
  };
  const refusals = refusalsOf(start.error);
  const nameOf = (id: string): string => recordings?.find((recording) => recording.id === id)?.name ?? "A recording that is gone";
  const submit = (): void =>
    start.mutate(
      { recordings: [...chosen], params: options.changed },
      {
        onSuccess: ({ batch }) => {
          setChosen(new Set());
          onClose();
          onStarted(batch.id);
        },
      },
    );

  return (
    <FormDialog title="Track several recordings" size={920} isOpen={isOpen} onClose={onClose} onSubmit={submit} verb={`Track ${formatCount(chosen.size, "recording")}`} isBusy={start.isPending} isReady={chosen.size > 0} note={<Text size="sm" className="quiet" role="status">{chosen.size === 0 ? "Choose recordings above" : "All start together, or none"}</Text>}>
      <section aria-label="Recordings to track">
        <Group justify="space-between" mb="sm">
          <Checkbox
            label={search ? "All that are shown" : "All recordings"}
            checked={areAllChosen}
            indeterminate={!areAllChosen && selectable.some((recording) => chosen.has(recording.id))}
            onChange={(event) => choose(selectable.map((recording) => recording.id), event.currentTarget.checked)}
          />
          <Group gap="sm">
            {projects.length > 0 && (
              <Select
                w={208}
                aria-label="Choose a whole project"
                placeholder="A whole project …"
                data={projects.map((project) => ({ value: project.id, label: project.name }))}
                value={null}
                onChange={chooseProject}
              />
            )}
            <TextInput
              value={search}
              onChange={(event) => setSearch(event.currentTarget.value)}
              placeholder="Filter by name"
              aria-label="Filter recordings by name"
              leftSection={<IconSearch size={16} aria-hidden />}
              w={240}
            />
          </Group>
        </Group>
        <ScrollArea.Autosize mah={152} className={classes.list} tabIndex={0} aria-label="Recordings">
          {!recordings && <Awaited what="The recordings" query={query} />}
          {recordings && shown.length === 0 && <Text className="quiet">Nothing is called “{search}”.</Text>}
          {shown.map((recording) => (
            <Checkbox
              key={recording.id}
              py={4}
              label={recording.name}
              description={obstacles?.get(recording.id) ?? formatCount(recording.frame_count, "frame")}
              disabled={!isTrackable(recording)}
              checked={chosen.has(recording.id)}
              onChange={(event) => choose([recording.id], event.currentTarget.checked)}
            />
          ))}
        </ScrollArea.Autosize>
      </section>
      {recordings?.[0] && <TrackingForm options={options} recording={recordings[0]} isForSeveral />}
      {start.error && (
        <Stack gap={4} role="alert">
          <Text size="sm" c="var(--bad-text)">
            {start.error.message}
          </Text>
          {refusals.map((refusal) => (
            <Text key={refusal.id} size="sm">
              {nameOf(refusal.id)}: {refusal.detail}
            </Text>
          ))}
        </Stack>
      )}
    </FormDialog>
  );
}
