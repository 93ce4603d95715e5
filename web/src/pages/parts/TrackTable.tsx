import { Group, Text } from "@mantine/core";
import { Link } from "react-router";
import type { Track } from "../../api/types";
import { formatAgo, formatNumber } from "../../model/format";
import { CardTable, type Column } from "./CardTable";
import { HandBadge } from "./HandBadge";
import classes from "./TrackTable.module.css";

const NAME: Column<Track> = {
  head: "Track",
  full: ({ name }) => name,
  show: ({ id, name }) => (
    <Link to={`/tracks/${id}`} className={classes.link}>
      {name}
    </Link>
  ),
};

const FACTS: readonly Column<Track>[] = [
  {
    head: "Hands",
    width: 136,
    show: ({ hands }) => (
      <Group gap="sm" wrap="nowrap">
        {hands.map((hand) => (
          <HandBadge key={hand} hand={hand} />
        ))}
      </Group>
    ),
  },
  { head: "Frames", width: 88, isNumber: true, show: ({ frame_count: count }) => String(count) },
  {
    head: "Lost",
    width: 72,
    isNumber: true,
    show: ({ summary: { lost } }) => (
      <Text span inherit c={lost > 0 ? "var(--bad-text)" : undefined} fw={lost > 0 ? 600 : undefined}>
        {lost}
      </Text>
    ),
  },
  { head: "Residual, mm", width: 128, isNumber: true, show: ({ summary }) => formatNumber(summary.depth_residual_mm) },
  { head: "Silhouette IoU", width: 136, isNumber: true, show: ({ summary }) => formatNumber(summary.silhouette_iou, 2) },
  { head: "Error, px", width: 96, isNumber: true, show: ({ error_px: error }) => formatNumber(error) },
  { head: "Median, ms", width: 120, isNumber: true, show: ({ summary }) => formatNumber(summary.median_ms) },
  { head: "Made", width: 128, isNumber: true, isQuiet: true, show: ({ created_at: when }) => formatAgo(when) },
];

interface TrackTableProps {
  tracks: readonly Track[];
  /** Name of a recording; left out where all rows are of one. */
  nameOf?: (sequenceId: string) => string | undefined;
}

export function TrackTable({ tracks, nameOf }: TrackTableProps) {
  const recording: Column<Track> = { head: "Recording", full: (track) => nameOf?.(track.sequence_id) ?? "", show: (track) => nameOf?.(track.sequence_id) };
  return <CardTable items={tracks} columns={nameOf ? [NAME, recording, ...FACTS] : [NAME, ...FACTS]} />;
}
