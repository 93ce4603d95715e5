import { ActionIcon, Button, Group, Title, Tooltip } from "@mantine/core";
import { IconCamera, IconTrash } from "@tabler/icons-react";
import { Link } from "react-router";
import { useRestore } from "../../api/bin";
import { useCalibrations, useRemoveCalibration, type Calibration } from "../../api/calibrations";
import { formatAgo, formatCount, formatNumber } from "../../model/format";
import { CardTable, type Column } from "../parts/CardTable";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { LoadingRows } from "../parts/LoadingRows";
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

const COLUMNS: readonly Column<Calibration>[] = [
  {
    head: "Calibration",
    full: ({ name }) => name,
    show: ({ id, name }) => (
      <Link to={`/calibrations/${id}`} className={classes.link}>
        {name}
      </Link>
    ),
  },
  { head: "State", width: 224, show: describeState },
  { head: "Cameras", width: 104, isNumber: true, show: ({ report }) => report.cameras.length },
  { head: "Left out, px", width: 136, isNumber: true, show: ({ result }) => formatNumber(result?.residual_px.left_out.rms, 2) },
  { head: "By the others, px", width: 160, isNumber: true, show: ({ result }) => formatNumber(result?.residual_px.by_other_cameras.rms, 2) },
  { head: "Made", width: 136, isNumber: true, isQuiet: true, show: ({ created_at: when }) => formatAgo(when) },
];

/** Cameras that were calibrated in the studio, and those on the way. */
export default function CalibrationsPage() {
  useTitle("Calibrated cameras");
  const { data, error, refetch } = useCalibrations();
  const removing = useRemoveCalibration();
  const restore = useRestore();
  if (error && !data) return <Failure what="The calibrations could not be loaded" error={error} safe="They are untouched on the server's disk." onRetry={() => void refetch()} />;
  const remove = ({ id, name }: Calibration): void =>
    removing.mutate(id, intoBin(`“${name}”`, () => restore.mutateAsync({ kind: "calibration", ids: [id] })));
  const acts: Column<Calibration> = {
    head: "",
    label: "Acts",
    width: 64,
    show: (one) => (
      <For role="lead">
        <Tooltip label="Delete (can be undone)">
          <ActionIcon onClick={() => remove(one)} aria-label={`Delete ${one.name}`}>
            <IconTrash size={16} />
          </ActionIcon>
        </Tooltip>
      </For>
    ),
  };
  return (
    <div className="page">
      <Group mb="lg" justify="space-between">
        <Title order={1}>Calibrated cameras</Title>
        {data && data.length > 0 && <Begin />}
      </Group>
      {!data && <LoadingRows count={4} height={44} />}
      {data?.length === 0 && (
        <EmptyState icon={<IconCamera size={56} stroke={1.25} />} title="No cameras are calibrated yet" action={<Begin />}>
          The positions of several cameras relative to each other must be known. Print a board, film it with all of them, and send the films: lenses, places and time offsets are found, and judged on moments that were left out.
        </EmptyState>
      )}
      {data && data.length > 0 && <CardTable items={data} columns={[...COLUMNS, acts]} />}
    </div>
  );
}
