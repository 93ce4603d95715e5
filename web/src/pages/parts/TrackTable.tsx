import { Group, Table, Text } from "@mantine/core";
import { Link } from "react-router";
import type { Track } from "../../api/types";
import { formatAgo, formatNumber } from "../../model/format";
import { HandBadge } from "./HandBadge";
import classes from "./TrackTable.module.css";

interface TrackTableProps {
  tracks: readonly Track[];
  /** Name of a recording; left out where all rows are of one. */
  nameOf?: (sequenceId: string) => string | undefined;
}

export function TrackTable({ tracks, nameOf }: TrackTableProps) {
  return (
    <div className={`card ${classes.frame}`}>
      <Table highlightOnHover verticalSpacing="sm" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Track</Table.Th>
            {nameOf && <Table.Th>Recording</Table.Th>}
            <Table.Th>Hands</Table.Th>
            <Table.Th ta="right">Frames</Table.Th>
            <Table.Th ta="right">Lost</Table.Th>
            <Table.Th ta="right">Residual, mm</Table.Th>
            <Table.Th ta="right">Silhouette IoU</Table.Th>
            <Table.Th ta="right">Error, px</Table.Th>
            <Table.Th ta="right">Median, ms</Table.Th>
            <Table.Th ta="right">Made</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {tracks.map((track) => (
            <Table.Tr key={track.id}>
              <Table.Td className={classes.name}>
                <Link to={`/tracks/${track.id}`} className={classes.link}>
                  {track.name}
                </Link>
              </Table.Td>
              {nameOf && <Table.Td className={classes.name}>{nameOf(track.sequence_id) ?? "–"}</Table.Td>}
              <Table.Td>
                <Group gap="sm" wrap="nowrap">
                  {track.hands.map((hand) => (
                    <HandBadge key={hand} hand={hand} />
                  ))}
                </Group>
              </Table.Td>
              <Table.Td ta="right">{track.frame_count}</Table.Td>
              <Table.Td ta="right" c={track.summary.lost > 0 ? "var(--bad-text)" : undefined} fw={track.summary.lost > 0 ? 600 : undefined}>
                {track.summary.lost}
              </Table.Td>
              <Table.Td ta="right">{formatNumber(track.summary.depth_residual_mm)}</Table.Td>
              <Table.Td ta="right">{formatNumber(track.summary.silhouette_iou, 2)}</Table.Td>
              <Table.Td ta="right">{formatNumber(track.error_px)}</Table.Td>
              <Table.Td ta="right">{formatNumber(track.summary.median_ms)}</Table.Td>
              <Table.Td ta="right">
                <Text size="sm" className="quiet one-line">
                  {formatAgo(track.created_at)}
                </Text>
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}
