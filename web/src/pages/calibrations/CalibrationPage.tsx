import { Button, Group, Text, Title } from "@mantine/core";
import { useEffect } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { useCalibration, useCheckFilms, type Calibration } from "../../api/calibrations";
import { isActive, useJob } from "../../api/jobs";
import { formatAgo, formatBytes, formatCount } from "../../model/format";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { tellFailure } from "../parts/undo";
import { CalibrationResult, Downloads } from "./CalibrationResult";
import { FilmsChecked } from "./FilmsChecked";
import { Working } from "./Working";

/** What has a result stays as it is: the same films with other options are another calibration. */
function Again({ calibration }: { calibration: Calibration }) {
  const check = useCheckFilms(calibration.id);
  const navigate = useNavigate();
  return (
    <For role="lead">
      <Button variant="default" loading={check.isPending} onClick={() => check.mutate(calibration.options, { onSuccess: ({ id }) => void navigate(`/calibrations/${id}`), onError: tellFailure })}>
        With other options …
      </Button>
    </For>
  );
}

/** One calibration: its films and what is wrong with them, then the job, then the cameras. The address can be sent to a colleague. */
export default function CalibrationPage() {
  const { calibrationId = "" } = useParams();
  const { data: calibration, error, refetch } = useCalibration(calibrationId);
  const job = useJob(calibration?.job_id ?? "").data;
  const hasEnded = job?.state === "succeeded" && calibration?.result === null;
  useEffect(() => {
    if (hasEnded) void refetch();
  }, [hasEnded, refetch]);
  useTitle(calibration?.name ?? "Calibration");
  if (error && !calibration)
    return (
      <Failure what="This calibration could not be loaded" error={error} safe="Films that nobody used for long are removed; cameras that were calibrated stay." onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/calibrations">
          To the calibrations
        </Button>
      </Failure>
    );
  if (!calibration) return <PageSkeleton />;
  const { result, report } = calibration;
  const isWorking = job !== undefined && isActive(job);
  return (
    <div className="page">
      <Group justify="space-between" mb="lg" align="flex-start" wrap="nowrap">
        <div style={{ minWidth: 0 }}>
          <Title order={1} className="few-lines">
            {calibration.name}
          </Title>
          <Text className="quiet" mt={4}>
            {formatCount(report.cameras.length, "camera")}, {formatBytes(calibration.byte_count)} of film, sent {formatAgo(calibration.created_at)}.
          </Text>
        </div>
        <Group gap="sm" wrap="nowrap">
          <Button variant="default" component={Link} to="/calibrations">
            All calibrations
          </Button>
          {result && <Again calibration={calibration} />}
          {result && <Downloads id={calibration.id} result={result} />}
        </Group>
      </Group>
      {job && !result && <Working job={job} />}
      {result ? <CalibrationResult calibration={calibration} result={result} /> : !isWorking && job?.state !== "succeeded" && <FilmsChecked key={calibration.id} calibration={calibration} />}
    </div>
  );
}
