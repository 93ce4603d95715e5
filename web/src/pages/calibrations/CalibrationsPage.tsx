import { ActionIcon, Button, Group, Skeleton, Table, Text, Title, Tooltip } from "@mantine/core";
import { IconCamera, IconTrash } from "@tabler/icons-react";
import { Link } from "react-router";
import { useRestore } from "../../api/bin";
import { useCalibrations, useRemoveCalibration, type Calibration } from "../../api/calibrations";
import { formatAgo, formatCount, formatNumber } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { useTitle } from "../parts/useTitle";
import { intoBin } from "../parts/undo";
import classes from "./calibrations.module.css";

const Begin = () => (
  <For role="lead">
    <Button component={Link} to="/calibrations/new" leftSection={<IconCamera size={16} aria-hidden />}>
      Calibrate cameras
    </Button>
  </For>
);

function describeState({ result, state, job_id: job }: Calibration): string {
  if (result) return result.warnings.length > 0 ? `done, ${formatCount(result.warnings.length, "thing")} to look at` : "done";
  if (job) return "started";
  return state === "refused" ? "something must be mended" : "checked, not started";
}

/** Cameras that were calibrated in the studio, and those on the way. */
export default function CalibrationsPage() {
  useTitle("Calibrated cameras");
  const { data, error, refetch } = useCalibrations();
  const removing = useRemoveCalibration();
  const restore = useRestore();
  if (error && !data) return <Failure what="The calibrations could not be loaded" error={error} safe="They are untouched on the server's disk." onRetry={() => void refetch()} />;
  if (data?.length === 0)
    return (
      <EmptyState icon={<IconCamera size={56} stroke={1.25} />} title="No cameras are calibrated yet" action={<Begin />}>
        The positions of several cameras relative to each other must be known. Print a board, film it with all of them, and send the films: lenses, places and time offsets are found, and judged on moments that were left out.
      </EmptyState>
    );
  const remove = ({ id, name }: Calibration): void =>
    removing.mutate(id, intoBin(`“${name}”`, () => restore.mutateAsync({ kind: "calibration", ids: [id] })));
  return (
    <div className="page">
      <Group mb="lg" justify="space-between">
        <Title order={1}>Calibrated cameras</Title>
        <Begin />
      </Group>
      {!data ? (
        <Skeleton height={240} radius="lg" />
      ) : (
        <div className={`card ${classes.table}`}>
          <Table highlightOnHover verticalSpacing="sm" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Calibration</Table.Th>
                <Table.Th>State</Table.Th>
                <Table.Th ta="right">Cameras</Table.Th>
                <Table.Th ta="right">Left out, px</Table.Th>
                <Table.Th ta="right">By the others, px</Table.Th>
                <Table.Th ta="right">Made</Table.Th>
                <Table.Th w={56} aria-label="Acts" />
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {data.map((one) => (
                <Table.Tr key={one.id}>
                  <Table.Td className={classes.name}>
                    <Link to={`/calibrations/${one.id}`} className={classes.link}>
                      {one.name}
                    </Link>
                  </Table.Td>
                  <Table.Td>{describeState(one)}</Table.Td>
                  <Table.Td ta="right">{one.report.cameras.length}</Table.Td>
                  <Table.Td ta="right">{formatNumber(one.result?.residual_px.left_out.rms, 2)}</Table.Td>
                  <Table.Td ta="right">{formatNumber(one.result?.residual_px.by_other_cameras.rms, 2)}</Table.Td>
                  <Table.Td ta="right">
                    <Text size="sm" className="quiet one-line">
                      {formatAgo(one.created_at)}
                    </Text>
                  </Table.Td>
                  <Table.Td>
                    <For role="lead">
                      <Tooltip label="Delete (can be undone)">
                        <ActionIcon onClick={() => remove(one)} aria-label={`Delete ${one.name}`}>
                          <IconTrash size={16} />
                        </ActionIcon>
                      </Tooltip>
                    </For>
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
    </div>
  );
}
