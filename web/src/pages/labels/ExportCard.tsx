import { Button, Input, Select, Skeleton, Stack, Text, Title } from "@mantine/core";
import { IconDownload } from "@tabler/icons-react";
import { useState } from "react";
import { exportUrl, useExportNotes, useLabelFormats, type Snapshot } from "../../api/labels";
import { useTracks } from "../../api/tracks";
import type { Recording } from "../../api/types";
import { formatBytes, formatCount } from "../../model/format";
import { ALL_SOURCES } from "../../model/source";
import { Refusal } from "../parts/Refusal";
import { SourceFilter } from "../parts/SourceFilter";
import classes from "./LabelsPage.module.css";

/** Labels for other programs, with what each format loses said before. */
export function ExportCard({ recording, snapshots }: { recording: Recording; snapshots: readonly Snapshot[] }) {
  const formats = useLabelFormats().data?.items ?? [];
  const tracks = useTracks(recording.id).data ?? [];
  const [name, setName] = useState("coco_keypoints");
  const [snapshot, setSnapshot] = useState("now");
  const [track, setTrack] = useState("");
  const [sources, setSources] = useState<readonly string[]>([ALL_SOURCES]);
  const format = formats.find((item) => item.name === name);
  const choice = {
    format: name,
    snapshot_id: snapshot === "now" ? undefined : snapshot,
    source: sources,
    track_id: format?.needs_3d && track ? track : undefined,
  };
  const { data: notes, error, isFetching } = useExportNotes(recording.id, choice);
  return (
    <section className="card" aria-label="Export" style={{ padding: 16 }}>
      <Stack gap="sm">
        <Title order={2}>Export</Title>
        <Select label="Format" data={formats.map((item) => ({ value: item.name, label: item.title }))} value={name} onChange={(value) => value && setName(value)} allowDeselect={false} />
        <Select
          label="Labels"
          data={[{ value: "now", label: "As they are now" }, ...snapshots.map(({ id, version, name: title }) => ({ value: id, label: `Version ${version} · ${title}` }))]}
          value={snapshot}
          onChange={(value) => value && setSnapshot(value)}
          allowDeselect={false}
        />
        <Input.Wrapper label="Joints" labelElement="div">
          <div>
            <SourceFilter chosen={sources} onChange={setSources} />
          </div>
        </Input.Wrapper>
        {format?.needs_3d && (
          <Select
            label="Joints in space"
            data={[{ value: "", label: "From the labels: two cameras, or depth" }, ...tracks.map((item) => ({ value: item.id, label: `From ${item.name}, a machine's guess` }))]}
            value={track}
            onChange={(value) => setTrack(value ?? "")}
            allowDeselect={false}
          />
        )}
        {format && (
          <div>
            <Text size="sm">Holds {format.holds}.</Text>
            {format.loses.length > 0 ? (
              <>
                <Text size="sm" mt={4}>
                  Lost in it:
                </Text>
                <ul className={classes.notes} aria-label="What is lost">
                  {format.loses.map((loss) => (
                    <li key={loss}>{loss}</li>
                  ))}
                </ul>
              </>
            ) : (
              <Text size="sm" className="quiet">
                Nothing is lost.
              </Text>
            )}
          </div>
        )}
        {isFetching && !notes && <Skeleton h={48} />}
        {error && <Refusal error={error} />}
        {notes && !error && (
          <div data-testid="export-notes">
            <Text size="sm" fw={600}>
              Here: {formatCount(notes.items, "hand")}, {formatCount(notes.joints, "joint")}, {formatBytes(notes.bytes)}
            </Text>
            <ul className={classes.notes}>
              {notes.notes.map((note) => (
                <li key={note}>{note}</li>
              ))}
            </ul>
          </div>
        )}
        {notes && !error ? (
          <Button component="a" href={exportUrl(recording.id, choice)} download title={notes.file} styles={{ label: { display: "block", height: "auto", paddingBlock: 6, textOverflow: "ellipsis" } }} leftSection={<IconDownload size={16} aria-hidden />}>
            Download {notes.file}
          </Button>
        ) : (
          <Button disabled leftSection={<IconDownload size={16} aria-hidden />}>
            Download
          </Button>
        )}
      </Stack>
    </section>
  );
}
