import { Radio, Table, Text } from "@mantine/core";
import { Link } from "react-router";
import type { Comparison, ErrorStatistics, JudgedTrack } from "../../api/evaluations";
import { formatNumber } from "../../model/format";
import { BarCell } from "./BarCell";
import { Difference } from "./Difference";
import classes from "./Evaluations.module.css";
import { TrackName } from "./TrackName";

const MEASURES = [
  { key: "mean", label: "Mean" },
  { key: "std", label: "Std" },
  { key: "median", label: "Median" },
  { key: "p95", label: "95 %" },
  { key: "max", label: "Max" },
] as const;

const valuesOf = (tracks: readonly JudgedTrack[], pick: (track: JudgedTrack) => number | null): number[] =>
  tracks.map(pick).filter((value): value is number => value !== null);

interface SummaryTableProps {
  comparison: Comparison;
  /** As chosen; the comparison follows when the server has answered. */
  reference: string | null;
  onReference: (track: string) => void;
}

/** A row for each track, as in the papers: mean, standard deviation, maximum, and what they hide. */
export function SummaryTable({ comparison, reference, onReference }: SummaryTableProps) {
  const { tracks, within_px: within } = comparison;
  const isSeveral = tracks.length > 1;
  const parts = [
    { label: "Visible", of: (track: JudgedTrack): ErrorStatistics => track.visible },
    { label: "Occluded", of: (track: JudgedTrack): ErrorStatistics => track.occluded },
  ];
  return (
    <div className={`card ${classes.frame}`}>
      <Table verticalSpacing="xs" horizontalSpacing="sm" aria-label="Error of each track">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Track</Table.Th>
            {MEASURES.map(({ key, label }) => (
              <Table.Th key={key} ta="right" className="one-line">
                {label}
              </Table.Th>
            ))}
            <Table.Th ta="right" className="one-line">
              Within {within} px
            </Table.Th>
            {parts.map(({ label }) => (
              <Table.Th key={label} ta="right">
                {label}
              </Table.Th>
            ))}
            <Table.Th ta="right">Annotated</Table.Th>
            <Table.Th ta="right">Lost</Table.Th>
            {isSeveral && <Table.Th>Reference</Table.Th>}
            {isSeveral && <Table.Th>Difference</Table.Th>}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {tracks.map((track, place) => (
            <Table.Tr key={track.key}>
              <Table.Td className={classes.name}>
                <TrackName place={place} track={track} />
              </Table.Td>
              {track.error.count === 0 ? (
                <Table.Td colSpan={8}>
                  <Text size="sm" className="quiet">
                    Nothing to compare with.{" "}
                    <Link className={classes.link} to={`/recordings/${track.recording_key}/annotate?frame=0`}>
                      Annotate some of its frames
                    </Link>
                    , or choose other joints above.{track.left_out_joints > 0 && ` All ${track.left_out_joints} joints are left out because of their source.`}
                  </Text>
                </Table.Td>
              ) : (
                <>
                  {MEASURES.map(({ key }) => {
                    const values = valuesOf(tracks, (one) => one.error[key]);
                    return (
                      <BarCell key={key} value={track.error[key]} full={Math.max(...values)} isBest={isSeveral && track.error[key] === Math.min(...values)} />
                    );
                  })}
                  <BarCell value={track.within} full={1} isBest={isSeveral && track.within === Math.max(...valuesOf(tracks, (one) => one.within))}>
                    {formatNumber(100 * (track.within ?? 0))} %
                  </BarCell>
                  {parts.map(({ label, of }) => (
                    <BarCell
                      key={label}
                      value={of(track).mean}
                      full={Math.max(...valuesOf(tracks, (one) => of(one).mean))}
                      title={`${of(track).count} joints marked ${label.toLowerCase()}`}
                    />
                  ))}
                </>
              )}
              <Table.Td ta="right" title={`${track.evaluated} annotated hands judged, ${track.untracked} not in the track, ${track.error.count} joints`}>
                {track.annotated_frames}
              </Table.Td>
              <Table.Td ta="right" className="one-line" c={track.lost > 0 ? "var(--bad-text)" : undefined} fw={track.lost > 0 ? 600 : undefined}>
                {track.lost} of {track.frames}
              </Table.Td>
              {isSeveral && (
                <Table.Td>
                  <Radio
                    size="xs"
                    checked={(reference ?? comparison.reference) === track.key}
                    onChange={() => onReference(track.key)}
                    aria-label={`${track.name} of ${track.recording} is the reference`}
                  />
                </Table.Td>
              )}
              {isSeveral && (
                <Table.Td>
                  {track.paired ? (
                    <Difference paired={track.paired} />
                  ) : (
                    <Text size="sm" className="quiet one-line">
                      {comparison.reference === track.key ? "the reference" : "nothing in common"}
                    </Text>
                  )}
                </Table.Td>
              )}
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}
