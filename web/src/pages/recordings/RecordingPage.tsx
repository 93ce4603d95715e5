import { Button, Code, Group, Menu, SimpleGrid, Skeleton, Stack, Text, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconChartBar, IconDownload, IconFileReport, IconFlag, IconPencil, IconPlayerPlay, IconTransfer } from "@tabler/icons-react";
import { useMemo } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { useRestore } from "../../api/bin";
import { useAnnotations } from "../../api/annotations";
import { API } from "../../api/client";
import { useRecordingJobs } from "../../api/jobs";
import { useDeleteRecording, useRecording } from "../../api/recordings";
import { useTracks } from "../../api/tracks";
import type { Recording } from "../../api/types";
import { FrameStrip } from "../../canvas/FrameStrip";
import { annotationRows } from "../../model/annotationRows";
import { formatAgo, formatCount, formatDuration, formatNumber } from "../../model/format";
import { workText } from "../parts/WorkProgress";
import { fromWire, keyText, type Pose } from "../../model/pose";
import { CameraPicture } from "./CameraPicture";
import { EditableName } from "./EditableName";
import { Failure } from "../parts/Failure";
import { HandBadge } from "../parts/HandBadge";
import { ImportFacts } from "../parts/ImportFacts";
import { JobRow } from "../parts/JobRow";
import { MoreMenu } from "../parts/MoreMenu";
import { PageSkeleton } from "../parts/PageSkeleton";
import { RefineCameras } from "./RefineCameras";
import { Sentences } from "../parts/Sentences";
import { Awaited } from "../parts/Awaited";
import { StartTracking, whereItStarts } from "./StartTracking";
import { TrackButton, useTrackObstacles } from "./TrackButton";
import { TrackTable } from "../parts/TrackTable";
import { useTitle } from "../parts/useTitle";
import { intoBin } from "../parts/undo";

function Cameras({ recording, tracks }: { recording: Recording; tracks: number }) {
  return (
    <section aria-label="Cameras">
      <Title order={2} mb="sm">
        {formatCount(recording.cameras.length, "camera")}
      </Title>
      <SimpleGrid cols={{ base: 1, md: 2 }} spacing="md">
        {recording.cameras.map((camera) => (
          <div key={camera.id} className="card" style={{ display: "flex", overflow: "hidden" }}>
            <CameraPicture recording={recording} camera={camera} />
            <Stack gap={4} p="md" style={{ minWidth: 0 }} flex={1}>
              <Text fw={600} className="one-line">
                {camera.id}
              </Text>
              <Text size="sm" className="quiet">
                {camera.width} × {camera.height} px, {[camera.has_color && "colour", camera.has_depth && "depth"].filter(Boolean).join(" and ")}
              </Text>
              <Text size="sm" className="quiet">
                fx {formatNumber(camera.K[0]?.[0])}, fy {formatNumber(camera.K[1]?.[1])}, centre {formatNumber(camera.K[0]?.[2])}, {formatNumber(camera.K[1]?.[2])} px
              </Text>
              <Text size="sm" className="quiet">
                {camera.distortion.length > 0 ? `distortion ${camera.distortion.map((value) => formatNumber(value, 3)).join(", ")}` : "no distortion"}
                {camera.depth_scale ? `, depth unit ${Number((1000 * camera.depth_scale).toPrecision(4))} mm` : ""}
              </Text>
            </Stack>
          </div>
        ))}
      </SimpleGrid>
      <RefineCameras recording={recording} tracks={tracks} />
    </section>
  );
}

export function RecordingPage() {
  const { recordingId = "" } = useParams();
  const { data: recording, error, refetch } = useRecording(recordingId);
  const annotations = useAnnotations(recordingId);
  const tracks = useTracks(recordingId);
  const jobs = useRecordingJobs(recordingId).data ?? [];
  const remove = useDeleteRecording();
  const restore = useRestore();
  const navigate = useNavigate();
  const [isTracking, tracking] = useDisclosure(false);
  const obstacles = useTrackObstacles(recording);
  const [isReportShown, report] = useDisclosure(false);
  useTitle(recording?.name);

  const rows = useMemo(() => {
    const poses: Record<string, Pose> = {};
    for (const item of annotations.data ?? []) poses[keyText(item)] = fromWire(item.points);
    return annotationRows(poses, recording?.frame_count ?? 0);
  }, [annotations.data, recording?.frame_count]);

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

  const drop = (): void =>
    remove.mutate(
      recording,
      intoBin(recording.name, () => restore.mutateAsync({ kind: "recording", ids: [recording.id] }), () => void navigate("/recordings")),
    );
  const openFrame = (frame: number): void => void navigate(`/recordings/${recording.id}/annotate?frame=${frame}`);

  return (
    <div className="page">
      <Group justify="space-between" align="flex-start" wrap="nowrap" mb="lg">
        <div style={{ minWidth: 0 }}>
          <EditableName recording={recording} />
          <Group gap="md" mt={4} className="quiet">
            <Text size="sm">
              {formatCount(recording.frame_count, "frame")}, {formatDuration(recording.frame_count / recording.fps)} at {formatNumber(recording.fps, 0)} fps
            </Text>
            {recording.hands.map((hand) => (
              <HandBadge key={hand} hand={hand} />
            ))}
            {recording.objects.map((object) => (
              <Text key={object.name} size="xs" c="var(--object-text)">
                {object.name}
              </Text>
            ))}
            <Text size="sm">imported {formatAgo(recording.created_at)}</Text>
          </Group>
        </div>
        <Group gap="sm" wrap="nowrap">
          <Button variant="default" component={Link} to={`/recordings/${recording.id}/annotate`} leftSection={<IconPencil size={16} aria-hidden />}>
            Annotate
          </Button>
          <TrackButton recording={recording} onClick={tracking.open} leftSection={<IconPlayerPlay size={16} aria-hidden />} />
          <MoreMenu isLarge onDelete={drop}>
            <Menu.Item component="a" href={`${API}/sequences/${recording.id}/annotations.json`} download leftSection={<IconDownload size={16} aria-hidden />}>
              Download annotations.json
            </Menu.Item>
          </MoreMenu>
        </Group>
      </Group>

      <Stack gap="xl">
        <section aria-label="Annotation by frame">
          <Group justify="space-between" mb="sm">
            <Title order={2}>Annotation</Title>
            <Group gap="md">
              <Text size="sm" className="quiet">
                {workText(recording.done_frames, recording.annotated_frames - recording.done_frames, recording.frame_count)}; click a frame to annotate it
              </Text>
              <Button size="xs" variant="subtle" component={Link} to={`/recordings/${recording.id}/check`} leftSection={<IconFlag size={16} aria-hidden />}>
                Label check
              </Button>
              <Button size="xs" variant="subtle" component={Link} to={`/recordings/${recording.id}/labels`} leftSection={<IconTransfer size={16} aria-hidden />}>
                Snapshots, export, import
              </Button>
            </Group>
          </Group>
          <div className="card" style={{ padding: 16 }}>
            {annotations.data ? (
              <FrameStrip rows={rows} frameCount={recording.frame_count} frame={null} height={32} label="Annotated frames" onSeek={openFrame} />
            ) : (
              <Awaited what="What is annotated" query={annotations} height={32} />
            )}
            <Group gap="md" mt="sm">
              <HandBadge hand="right" />
              <HandBadge hand="left" />
            </Group>
          </div>
        </section>

        <Cameras recording={recording} tracks={tracks.data?.length ?? 0} />

        <section aria-label="Tracks">
          <Group justify="space-between" mb="sm">
            <Title order={2}>Tracks</Title>
            {tracks.data && tracks.data.length > 0 && (
              <Button size="xs" variant="subtle" component={Link} to={`/evaluations?recordings=${recording.id}`} leftSection={<IconChartBar size={16} aria-hidden />}>
                Evaluate and compare
              </Button>
            )}
          </Group>
          {!tracks.data && tracks.error && <Failure what="The tracks could not be loaded" error={tracks.error} onRetry={() => void tracks.refetch()} />}
          {tracks.isPending && <Skeleton height={96} radius="lg" role="status" aria-label="The tracks are loaded" />}
          {tracks.data && tracks.data.length > 0 && <TrackTable tracks={tracks.data} />}
          {tracks.data?.length === 0 && (
            <Group className="card" p="md" justify="space-between">
              <Text className="quiet" style={{ flex: 1 }}>
                {obstacles.length > 0
                  ? `It cannot be tracked. ${obstacles.join(" ")}`
                  : `Not tracked yet. The tracker starts ${whereItStarts(recording)}`}
              </Text>
              <TrackButton recording={recording} variant="default" onClick={tracking.open} />
            </Group>
          )}
        </section>

        {jobs.length > 0 && (
          <Stack gap="sm" component="section" aria-label="Jobs">
            <Title order={2}>Jobs</Title>
            {jobs.slice(0, 5).map((job) => (
              <JobRow key={job.id} job={job} recording={recording.name} />
            ))}
          </Stack>
        )}

        {recording.report && (
          <section aria-label="Import report">
            <Group mb="sm" justify="space-between">
              <Title order={2}>Import report</Title>
              <Button variant="subtle" size="xs" onClick={report.toggle} aria-expanded={isReportShown} leftSection={<IconFileReport size={16} aria-hidden />}>
                {isReportShown ? "Hide" : "Show"}
              </Button>
            </Group>
            <Text className="quiet" size="sm" mb="sm">
              {recording.report.warnings.length ? `${formatCount(recording.report.warnings.length, "thing")} worth knowing` : "Nothing unusual was found"}. Content key{" "}
              <Code>{recording.content_key.slice(0, 12)}</Code>
            </Text>
            {isReportShown && (
              <Stack gap="md">
                <Sentences title="Worth knowing" sentences={recording.report.warnings} isProblem={false} />
                <ImportFacts report={recording.report} />
              </Stack>
            )}
          </section>
        )}
      </Stack>
      <StartTracking recording={recording} isOpen={isTracking} onClose={tracking.close} />
    </div>
  );
}
