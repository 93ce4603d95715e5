import { Group, Table, Text } from "@mantine/core";
import type { Comparison } from "../../api/evaluations";
import { errorColor, errorGradient } from "../../model/errorColor";
import { BarCell } from "./BarCell";
import classes from "./Evaluations.module.css";
import { TrackName } from "./TrackName";

/** Error at which the colours of joints and pictures end, px; as in `tracker/evaluation/worst_picture.py`. */
export const ERROR_FULL_PX = 20;

export function PixelLegend() {
  return (
    <Group gap={6} wrap="nowrap" className="quiet">
      <Text size="xs">0</Text>
      <span className={classes.scale} style={{ background: errorGradient }} aria-hidden />
      <Text size="xs">{ERROR_FULL_PX} px and more</Text>
    </Group>
  );
}

/** Mean, standard deviation and maximum of every joint. */
export function JointTable({ comparison }: { comparison: Comparison }) {
  const { tracks, joints } = comparison;
  const full = Math.max(0, ...tracks.flatMap((track) => track.by_joint.map((found) => found.mean ?? 0)));
  return (
    <div className={`card ${classes.frame}`}>
      <Table verticalSpacing={4} horizontalSpacing="md" aria-label="Error of each joint">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Joint</Table.Th>
            {tracks.map((track, place) => (
              <Table.Th key={track.key} className={classes.name}>
                <TrackName place={place} track={track} />
              </Table.Th>
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {joints.map((joint, place) => (
            <Table.Tr key={joint}>
              <Table.Td className="one-line">{joint.replace("_", " ")}</Table.Td>
              {tracks.map((track) => {
                const found = track.by_joint[place];
                return (
                  <BarCell key={track.key} value={found?.mean ?? null} full={full} color={errorColor((found?.mean ?? 0) / ERROR_FULL_PX)}>
                    {found?.mean?.toFixed(2)} ± {found?.std?.toFixed(2)} <span className="quiet">max {found?.max?.toFixed(1)}</span>
                  </BarCell>
                );
              })}
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}
