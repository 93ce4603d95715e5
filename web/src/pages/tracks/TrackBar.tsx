import { ActionIcon, Badge, Button, Group, Menu, Select, Text, Tooltip } from "@mantine/core";
import { IconAlertTriangle, IconChartBar, IconCircleCheck, IconDownload, IconHandFinger, IconPencil, IconPlayerTrackNext, IconRefresh } from "@tabler/icons-react";
import { Link, useNavigate } from "react-router";
import { useRestore } from "../../api/bin";
import { EXPORTS, exportUrl, trackFileUrl, useDeleteTrack } from "../../api/tracks";
import type { Recording, Track } from "../../api/types";
import classes from "./TrackReview.module.css";
import { FrameSteps } from "../parts/FrameSteps";
import { KeyIcon } from "../parts/KeyIcon";
import { MoreMenu } from "../parts/MoreMenu";
import { intoBin } from "../parts/undo";

interface TrackBarProps {
  track: Track;
  recording: Recording;
  frame: number;
  status: string | null;
  isPlaying: boolean;
  hasLost: boolean;
  camera: string;
  /** The choice of all cameras. */
  all: string;
  onCamera: (camera: string) => void;
  onPlay: () => void;
  onStep: (by: number) => void;
  onBad: (direction: 1 | -1) => void;
  onAnnotate: () => void;
}

const STEPS = { play: "track.play", previous: "track.previous", next: "track.next" };
const STATUS_ICONS = { ok: IconCircleCheck, lost: IconAlertTriangle, recovered: IconRefresh } as const;

/** Which track, which frame, and how it went there. */
export function TrackBar(props: TrackBarProps) {
  const { track, recording, frame, status, isPlaying, hasLost, camera, all, onCamera, onPlay, onStep, onBad, onAnnotate } = props;
  const remove = useDeleteTrack();
  const restore = useRestore();
  const navigate = useNavigate();
  const StatusIcon = STATUS_ICONS[status as keyof typeof STATUS_ICONS];
  const drop = (): void =>
    remove.mutate(
      track.id,
      intoBin(track.name, () => restore.mutateAsync({ kind: "track", ids: [track.id] }), () => void navigate("/tracks")),
    );

  return (
    <div className={classes.bar}>
      <Text className={`one-line ${classes.name}`} fw={600} title={track.name}>
        {track.name}
      </Text>
      <Text size="sm" className="quiet one-line">
        of{" "}
        <Link to={`/recordings/${recording.id}`} className={classes.title} title={recording.name}>
          {recording.name}
        </Link>
      </Text>
      {track.summary.detector && (
        <Tooltip label={`Fingertips were found by the detector “${track.summary.detector.name}”, SHA-256 ${track.summary.detector.sha256}`} multiline maw={480}>
          <Badge variant="light" color="gray" tt="none" maw={160} miw={0} tabIndex={0} leftSection={<IconHandFinger size={12} aria-hidden />} aria-label={`Fingertip detector ${track.summary.detector.name}`}>
            {track.summary.detector.name}
          </Badge>
        </Tooltip>
      )}
      {track.is_of_earlier_cameras && (
        <Tooltip label="The cameras of this recording were changed after the track was made. Track again, or judge it with care." multiline maw={360}>
          <Badge variant="light" color="yellow" tt="none" tabIndex={0} leftSection={<IconAlertTriangle size={12} aria-hidden />}>
            earlier cameras
          </Badge>
        </Tooltip>
      )}
      {recording.cameras.length > 1 && (
        <Select size="xs" w={136} aria-label="Camera" allowDeselect={false} data={[{ value: all, label: "All cameras" }, ...recording.cameras.map((one) => one.id)]} value={camera} onChange={(id) => id && onCamera(id)} />
      )}
      <Group gap={4} ml="auto" wrap="nowrap" className={classes.controls}>
        <Group gap={4} wrap="nowrap" className={classes.status} data-status={status ?? ""} role="status">
          {StatusIcon && <StatusIcon size={15} aria-hidden />}
          {status ?? "not tracked"}
        </Group>
        <FrameSteps isPlaying={isPlaying} actions={STEPS} onPlay={onPlay} onStep={onStep}>
          <Text size="sm" ta="center" miw={96} data-testid="frame">
            frame {frame}
          </Text>
        </FrameSteps>
        <KeyIcon label={hasLost ? "Next lost frame" : "Next of the worst frames"} action="track.nextBad" onClick={() => onBad(1)}>
          <IconPlayerTrackNext size={18} />
        </KeyIcon>
        <Tooltip label="Annotate this frame (A)">
          <Button size="compact-sm" variant="default" ml="sm" leftSection={<IconPencil size={14} aria-hidden />} onClick={onAnnotate}>
            Annotate
          </Button>
        </Tooltip>
        <Tooltip label="Evaluate this track, or compare it with the others of its recording">
          <ActionIcon component={Link} to={`/evaluations?recordings=${recording.id}&reference=${track.id}`} aria-label="Evaluate and compare">
            <IconChartBar size={18} />
          </ActionIcon>
        </Tooltip>
        <MoreMenu onDelete={drop}>
          <Menu.Label>Download</Menu.Label>
          {EXPORTS.filter((one) => !one.isOfHands || track.hands.length > 0).map(({ kind, label }) => (
            <Menu.Item key={kind} component="a" href={exportUrl(track.id, kind)} leftSection={<IconDownload size={16} aria-hidden />}>
              {label}
            </Menu.Item>
          ))}
          <Menu.Item component="a" href={trackFileUrl(track.id, "summary.json")} leftSection={<IconDownload size={16} aria-hidden />}>
            Summary (JSON)
          </Menu.Item>
          <Menu.Divider />
          {track.job_id && (
            <Menu.Item component={Link} to={`/jobs/${track.job_id}`}>
              To the job
            </Menu.Item>
          )}
        </MoreMenu>
      </Group>
    </div>
  );
}
