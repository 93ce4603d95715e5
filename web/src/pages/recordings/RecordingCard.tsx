import { Group, Text, Tooltip } from "@mantine/core";
import { useState } from "react";
import { Link } from "react-router";
import type { Recording } from "../../api/types";
import { formatCount, formatMeasure, formatNumber } from "../../model/format";
import { HandBadge } from "../parts/HandBadge";
import { HoverPlay } from "./HoverPlay";
import classes from "./RecordingCard.module.css";
import { WorkProgress } from "../parts/WorkProgress";

/** What the best track is worth, in one line: error in px when there are annotations, else the depth residual. */
export function trackWorth(track: Recording["best_track"]): string {
  if (!track) return "not tracked yet";
  const lost = track.summary.lost > 0 ? `, ${track.summary.lost} lost` : "";
  if (track.error_px !== null && track.error_px !== undefined) return `${formatNumber(track.error_px)} px error${lost}`;
  const residual = formatMeasure(track.summary.depth_residual_mm, "mm");
  return `${residual === "–" ? "tracked" : `${residual} residual`}${lost}`;
}

export function RecordingCard({ recording }: { recording: Recording }) {
  const [isPlaying, setPlaying] = useState(false);
  const done = recording.done_frames;
  const begun = recording.annotated_frames - done;
  return (
    <Link
      to={`/recordings/${recording.id}`}
      className={`card ${classes.card}`}
      onMouseEnter={() => setPlaying(true)}
      onMouseLeave={() => setPlaying(false)}
      onFocus={() => setPlaying(true)}
      onBlur={() => setPlaying(false)}
    >
      <HoverPlay recording={recording} isPlaying={isPlaying} />
      <div className={classes.body}>
        <Tooltip label={recording.name} disabled={recording.name.length < 28} multiline maw={360}>
          <Text fw={600} className="one-line">
            {recording.name}
          </Text>
        </Tooltip>
        <Group gap="sm" wrap="nowrap" className="quiet">
          <Text size="xs" className="one-line">
            {formatCount(recording.frame_count, "frame")} · {formatCount(recording.cameras.length, "camera")}
          </Text>
          <Group gap="sm" ml="auto" wrap="nowrap">
            {recording.hands.map((hand) => (
              <HandBadge key={hand} hand={hand} />
            ))}
          </Group>
        </Group>
        <WorkProgress done={done} partial={begun} total={recording.frame_count} size={4} my={4} />
        <Group gap="sm" justify="space-between" wrap="nowrap" className="quiet">
          <Text size="xs" className="one-line">
            {recording.annotated_frames === 0 ? "no annotations" : `${done} annotated${begun > 0 ? `, ${begun} begun` : ""}`}
          </Text>
          <Text size="xs" className="one-line">
            {trackWorth(recording.best_track)}
          </Text>
        </Group>
      </div>
    </Link>
  );
}
