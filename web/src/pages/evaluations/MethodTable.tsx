import { Table, Text } from "@mantine/core";
import type { Comparison } from "../../api/evaluations";
import { BarCell } from "./BarCell";
import { Difference } from "./Difference";
import classes from "./Evaluations.module.css";

/** Methods down, recordings across, as the papers' tables of sequences; pooled in the first columns. */
export function MethodTable({ comparison }: { comparison: Comparison }) {
  const { methods, tracks } = comparison;
  const recordings = [...new Map(tracks.map((track) => [track.recording_key, track.recording])).entries()];
  const byKey = new Map(tracks.map((track) => [track.key, track]));
  const full = Math.max(0, ...tracks.map((track) => track.error.mean ?? 0));
  return (
    <div className={`card ${classes.frame}`}>
      <Table verticalSpacing="xs" horizontalSpacing="md" aria-label="Error of each method in each recording">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Method</Table.Th>
            <Table.Th ta="right" className="one-line">
              All together
            </Table.Th>
            {recordings.map(([key, name]) => (
              <Table.Th key={key} ta="right" className="one-line" title={name} maw={168}>
                {name}
              </Table.Th>
            ))}
            <Table.Th ta="right">Lost</Table.Th>
            {methods.length > 1 && <Table.Th>Difference</Table.Th>}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {methods.map((method) => (
            <Table.Tr key={method.tracks.join()}>
              <Table.Td className={classes.name}>{method.name === "all alike" ? "The same parameters" : method.name}</Table.Td>
              <BarCell value={method.error.mean} full={full}>
                {method.error.mean?.toFixed(2)} ± {method.error.std?.toFixed(2)}
              </BarCell>
              {recordings.map(([key]) => {
                const own = method.tracks.map((id) => byKey.get(id)).find((track) => track?.recording_key === key);
                return (
                  <BarCell key={key} value={own?.error.mean ?? null} full={full} title={own ? `${own.name}, largest ${own.error.max?.toFixed(1)} px` : ""}>
                    {own?.error.mean?.toFixed(2)} ± {own?.error.std?.toFixed(2)}
                  </BarCell>
                );
              })}
              <Table.Td ta="right" className="one-line">
                {method.lost} of {method.frames}
              </Table.Td>
              {methods.length > 1 && (
                <Table.Td>
                  {method.paired ? (
                    <Difference paired={method.paired} />
                  ) : (
                    <Text size="sm" className="quiet one-line">
                      {method.is_reference ? "the reference's" : "nothing in common"}
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
