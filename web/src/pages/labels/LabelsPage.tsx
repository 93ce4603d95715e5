import { Anchor, Button, Group, Stack, Text, Title } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";
import { Link, useParams, useSearchParams } from "react-router";
import { useSnapshots } from "../../api/labels";
import { useRecording } from "../../api/recordings";
import { Failure } from "../parts/Failure";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { workText } from "../parts/WorkProgress";
import { Comparison } from "./Comparison";
import { ExportCard } from "./ExportCard";
import { ImportCard } from "./ImportCard";
import classes from "./LabelsPage.module.css";
import { SnapshotTable } from "./SnapshotTable";
import { For } from "../parts/For";

/** Labels of a recording: kept as snapshots, compared, taken out and in. `?compare=` and `?with=` hold what is compared. */
export default function LabelsPage() {
  const { recordingId = "" } = useParams();
  const [query, setQuery] = useSearchParams();
  const { data: recording, error, refetch } = useRecording(recordingId);
  const snapshots = useSnapshots(recordingId);
  useTitle(recording && `Labels of ${recording.name}`);

  if (error && !recording) {
    return (
      <Failure what="This recording could not be loaded" error={error} onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/recordings">
          To the recordings
        </Button>
      </Failure>
    );
  }
  if (!recording) return <PageSkeleton />;

  const compare = query.get("compare");
  const other = query.get("with") ?? "now";
  const choose = (snapshot: string | null, next = "now"): void =>
    setQuery(snapshot ? { compare: snapshot, with: next } : {}, { replace: true });

  return (
    <div className="page">
      <Group justify="space-between" align="flex-start" wrap="nowrap" mb="lg">
        <div style={{ minWidth: 0 }}>
          <Anchor component={Link} to={`/recordings/${recording.id}`} size="sm" c="var(--accent-text)" className="one-line" display="block">
            {recording.name}
          </Anchor>
          <Title order={1}>Labels</Title>
          <Text size="sm" className="quiet" mt={4}>
            {workText(recording.done_frames, recording.annotated_frames - recording.done_frames, recording.frame_count)}
          </Text>
        </div>
        <Button variant="default" component={Link} to={`/recordings/${recording.id}/annotate`} leftSection={<IconPencil size={16} aria-hidden />}>
          Annotate
        </Button>
      </Group>
      <div className={classes.columns}>
        <Stack gap="xl" style={{ minWidth: 0 }}>
          <SnapshotTable recording={recording} snapshots={snapshots} compared={compare} onCompare={choose} />
          {compare && (
            <Comparison recording={recording} snapshots={snapshots.data ?? []} snapshot={compare} other={other} onChoose={choose} />
          )}
        </Stack>
        <Stack gap="lg" style={{ minWidth: 0 }}>
          <ExportCard recording={recording} snapshots={snapshots.data ?? []} />
          <For role="lead">
            <ImportCard recording={recording} />
          </For>
        </Stack>
      </div>
    </div>
  );
}
