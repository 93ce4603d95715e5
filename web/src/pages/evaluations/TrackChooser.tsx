import { Button, Checkbox, Group, Select, Stack, Text, TextInput } from "@mantine/core";
import { IconRoute, IconSearch } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import { useEvaluableProjects } from "../../api/evaluations";
import { useRecordings } from "../../api/recordings";
import { useTracks } from "../../api/tracks";
import { formatCount, formatAgo, formatNumber } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { LoadingRows } from "../parts/LoadingRows";
import classes from "./Evaluations.module.css";

interface TrackChooserProps {
  initial: readonly string[];
  onChoose: (tracks: string[]) => void;
  onProject: (project: string) => void;
}

/** Tracks by recording, to be ticked; the first one ticked is the reference until another is chosen. */
export function TrackChooser({ initial, onChoose, onProject }: TrackChooserProps) {
  const tracks = useTracks();
  const recordings = useRecordings();
  const projects = (useEvaluableProjects().data ?? []).filter((project) => project.recordings > 0);
  const [ticked, setTicked] = useState<readonly string[]>(initial);
  const [search, setSearch] = useState("");
  const error = tracks.error ?? recordings.error;
  if (error && !(tracks.data && recordings.data)) {
    return <Failure what="The tracks could not be loaded" error={error} safe="Their files are untouched on the server's disk." onRetry={() => void Promise.all([tracks.refetch(), recordings.refetch()])} />;
  }
  if (!tracks.data || !recordings.data) return <LoadingRows count={5} height={48} />;
  if (tracks.data.length === 0) {
    return (
      <EmptyState
        icon={<IconRoute size={48} stroke={1.25} />}
        title="Nothing to evaluate yet"
        action={
          <Button component={Link} to="/recordings">
            Choose a recording
          </Button>
        }
      >
        An evaluation compares tracks with the joints that people marked. Open a recording, annotate some of its frames, and track it.
      </EmptyState>
    );
  }
  const wanted = search.trim().toLowerCase();
  const groups = recordings.data
    .map((recording) => ({ recording, own: tracks.data.filter((track) => track.sequence_id === recording.id) }))
    .filter(({ recording, own }) => own.length > 0 && recording.name.toLowerCase().includes(wanted));
  const toggle = (ids: readonly string[], on: boolean): void =>
    setTicked((now) => (on ? [...now, ...ids.filter((id) => !now.includes(id))] : now.filter((id) => !ids.includes(id))));

  return (
    <Stack gap="md">
      <Group gap="sm">
        <TextInput
          w={280}
          aria-label="Search recordings"
          placeholder="Search recordings"
          leftSection={<IconSearch size={16} aria-hidden />}
          value={search}
          onChange={(event) => setSearch(event.currentTarget.value)}
        />
        {projects.length > 0 && (
          <Select
            w={232}
            aria-label="A whole project"
            placeholder="or a whole project"
            data={projects.map((project) => ({ value: project.id, label: `${project.name} (${project.recordings})` }))}
            value={null}
            onChange={(id) => id && onProject(id)}
          />
        )}
        <Button ml="auto" disabled={ticked.length === 0} onClick={() => onChoose([...ticked])}>
          {ticked.length === 0 ? "Tick tracks to evaluate" : ticked.length === 1 ? "Evaluate 1 track" : `Compare ${ticked.length} tracks`}
        </Button>
      </Group>
      <div className={`card ${classes.chooser}`}>
        {groups.length === 0 && (
          <Text p="md" className="quiet">
            No recording with tracks has “{search}” in its name.
          </Text>
        )}
        {groups.map(({ recording, own }) => {
          const count = own.filter((track) => ticked.includes(track.id)).length;
          return (
            <section key={recording.id} className={classes.group} aria-label={recording.name}>
              <Checkbox
                label={<Text fw={600}>{recording.name}</Text>}
                description={
                  recording.annotated_frames > 0
                    ? `${recording.annotated_frames} of ${recording.frame_count} frames annotated`
                    : "not annotated yet, so there is nothing to judge its tracks by"
                }
                aria-label={`All tracks of ${recording.name}`}
                checked={count === own.length}
                indeterminate={count > 0 && count < own.length}
                onChange={(event) => toggle(own.map((track) => track.id), event.currentTarget.checked)}
              />
              <Stack gap={8} mt={8} pl={28}>
                {own.map((track) => (
                  <Checkbox
                    key={track.id}
                    size="xs"
                    label={
                      <>
                        {track.name}{" "}
                        <span className="quiet">
                          · {formatCount(track.frame_count, "frame")}, {track.summary.lost} lost{track.error_px === null ? "" : `, ${formatNumber(track.error_px, 2)} px`} · {formatAgo(track.created_at)}
                        </span>
                      </>
                    }
                    aria-label={`${track.name} of ${recording.name}`}
                    checked={ticked.includes(track.id)}
                    onChange={(event) => toggle([track.id], event.currentTarget.checked)}
                  />
                ))}
              </Stack>
            </section>
          );
        })}
      </div>
    </Stack>
  );
}
