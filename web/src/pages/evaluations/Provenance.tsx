import { Code, Table, Text, Title } from "@mantine/core";
import { Link } from "react-router";
import type { Comparison } from "../../api/evaluations";
import { formatName } from "../../model/format";
import classes from "./Evaluations.module.css";
import { TrackName } from "./TrackName";

const wordOf = (value: unknown): string => {
  if (typeof value === "boolean") return value ? "on" : "off";
  if (value === null || value === undefined) return "–";
  if (typeof value === "string") return value === "" ? "automatic" : value;
  return JSON.stringify(value);
};

/** Parameters that differ between the runs, side by side. */
export function ParameterTable({ comparison }: { comparison: Comparison }) {
  const { tracks, parameters } = comparison;
  const same = Object.entries(parameters.same).map(([name, value]) => `${formatName(name).toLowerCase()} ${wordOf(value)}`);
  return (
    <section aria-label="Parameters">
      <Title order={2} mb="sm">
        Parameters
      </Title>
      {parameters.different.length > 0 ? (
        <div className={`card ${classes.frame}`}>
          <Table verticalSpacing="xs" horizontalSpacing="md" aria-label="Parameters that differ">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Differing</Table.Th>
                {tracks.map((track, place) => (
                  <Table.Th key={track.key} className={classes.name}>
                    <TrackName place={place} track={track} />
                  </Table.Th>
                ))}
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {parameters.different.map(({ name, values }) => (
                <Table.Tr key={name}>
                  <Table.Td>{formatName(name)}</Table.Td>
                  {tracks.map((track) => (
                    <Table.Td key={track.key}>{wordOf(values[track.key])}</Table.Td>
                  ))}
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      ) : (
        tracks.length > 1 && <Text size="sm">All tracks were made with the same parameters.</Text>
      )}
      {same.length > 0 && (
        <Text size="sm" className="quiet" mt="sm">
          {tracks.length > 1 ? "The same in all: " : ""}
          {same.join(", ")}
        </Text>
      )}
    </section>
  );
}

/** Which labels judged which track. */
export function Lineage({ comparison }: { comparison: Comparison }) {
  return (
    <section aria-label="What was judged, and by which labels">
      <Title order={2} mb="sm">
        What was judged, and by which labels
      </Title>
      <div className={`card ${classes.frame}`}>
        <Table verticalSpacing="xs" horizontalSpacing="md">
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Track</Table.Th>
              <Table.Th>Its file</Table.Th>
              <Table.Th>Labels</Table.Th>
              <Table.Th>Their hash</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {comparison.tracks.map((track, place) => (
              <Table.Tr key={track.key}>
                <Table.Td className={classes.name}>
                  <TrackName place={place} track={track} />
                </Table.Td>
                <Table.Td>
                  <Code title={wordOf(track.origin["sha256"])}>{wordOf(track.origin["sha256"]).slice(0, 12)}</Code>
                </Table.Td>
                <Table.Td>
                  {track.labels["kind"] === "snapshot" ? `snapshot ${wordOf(track.labels["version"])}, ${wordOf(track.labels["name"])}` : `of now, revision ${wordOf(track.labels["revision"])}`}
                  , {wordOf(track.labels["items"])} hands ·{" "}
                  <Link className={classes.link} to={`/recordings/${track.recording_key}`}>
                    recording
                  </Link>
                </Table.Td>
                <Table.Td>
                  <Code title={wordOf(track.labels["sha256"])}>{wordOf(track.labels["sha256"]).slice(0, 12)}</Code>
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </div>
    </section>
  );
}
