import { Button, Group, Stack, Text, TextInput, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconCircleCheck } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { discardImport, useConfirmImport, useImport, type ImportOptions } from "../../api/imports";
import type { Import, ImportQuestion } from "../../api/types";
import { formatBytes, formatCount, formatFileFormat } from "../../model/format";
import { stillNeeded, withoutField } from "../../model/importForm";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ImportFacts } from "../parts/ImportFacts";
import { ImportOptionsForm } from "./ImportOptionsForm";
import { ImportPictures } from "./ImportPictures";
import { PageSkeleton } from "../parts/PageSkeleton";
import { Sentences } from "../parts/Sentences";
import { TakenCameras } from "./TakenCameras";
import { useLiveCheck } from "./useLiveCheck";
import { useTitle } from "../parts/useTitle";

interface ConfirmProps {
  checked: Import;
  /** What the report is about; the server stores nothing else. */
  options: ImportOptions;
  needed: readonly ImportQuestion[];
  isBehind: boolean;
}

function Confirm({ checked, options, needed, isBehind }: ConfirmProps) {
  const [name, setName] = useState(checked.name);
  const confirm = useConfirmImport(checked.id);
  const navigate = useNavigate();
  const store = (): void =>
    confirm.mutate(
      { name: name.trim(), options },
      {
        onSuccess: (recording) => {
          notifications.show({ message: `${recording.name} was imported.`, color: "teal" });
          void navigate(`/recordings/${recording.id}`, { replace: true });
        },
      },
    );
  return (
    <form
      className="card"
      style={{ padding: 16 }}
      onSubmit={(event) => {
        event.preventDefault();
        store();
      }}
    >
      <Group align="flex-end" gap="sm">
        <TextInput label="Name of the recording" value={name} onChange={(event) => setName(event.currentTarget.value)} maxLength={200} required flex={1} />
        <Button type="submit" loading={confirm.isPending} disabled={!name.trim() || !checked.report.ok || isBehind} leftSection={<IconCircleCheck size={16} aria-hidden />}>
          Store the recording
        </Button>
      </Group>
      {!checked.report.ok && (
        <Text size="sm" mt="sm" className="quiet" role="status">
          {needed.length > 0 ? `Still needed: ${needed.map(({ label }) => label.charAt(0).toLowerCase() + label.slice(1)).join(", ")}.` : "It can be stored once the problems above are fixed."}
        </Text>
      )}
      {confirm.error && (
        <Text size="sm" mt="sm" c="var(--bad-text)" role="alert">
          {confirm.error.message} Nothing was stored; try again.
        </Text>
      )}
    </form>
  );
}

/** Videos whose cameras may come from a calibration that was made in the studio. */
const isOfCameras = ({ calibration_id: taken, report }: Import): boolean =>
  taken !== null || (report.format === "synced_videos" && report.cameras.length > 1) || report.problems.some((problem) => problem.includes("videos and no calibration") || problem.includes("calibrated cameras"));

const KIND_OF: Record<string, string> = { depth_pattern: "depth", color_pattern: "color" };

/** A report, and the form beside it: one page from the files to the recording. */
function Checked({ checked }: { checked: Import }) {
  const live = useLiveCheck(checked);
  const { report } = checked;
  const questions = report.questions ?? [];
  const needed = stillNeeded(questions);
  const problems = withoutField(report.problems, questions);
  const isHopeless = !report.ok && report.cameras.length === 0 && needed.length === 0;
  return (
    <Stack gap="md">
      <Sentences title={problems.length === 1 ? "One thing must be fixed" : `${formatCount(problems.length, "thing")} must be fixed`} sentences={problems} isProblem />
      {isOfCameras(checked) && <TakenCameras checked={checked} />}
      {!isHopeless && <ImportPictures importId={checked.id} cameras={report.cameras} open={needed.flatMap(({ field }) => KIND_OF[field] ?? [])} />}
      {(report.takes ?? []).length > 0 && <ImportOptionsForm importId={checked.id} report={report} live={live} />}
      {!isHopeless && <Confirm checked={checked} options={checked.options as ImportOptions} needed={needed} isBehind={live.isBehind} />}
      <Sentences title="Worth knowing" sentences={report.warnings} isProblem={false} />
      {report.cameras.length > 0 && <ImportFacts report={report} />}
    </Stack>
  );
}

/** What was found in an import, before anything is stored; the address can be sent to a colleague. */
export default function ImportPage() {
  const { importId = "" } = useParams();
  const { data: checked, error, refetch } = useImport(importId);
  const navigate = useNavigate();
  useTitle("Import report");

  if (error && !checked) {
    return (
      <Failure what="This import report could not be loaded" error={error} safe="An import that was not confirmed is dropped after a while; recordings that were stored are in the list." onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/recordings">
          To the recordings
        </Button>
      </Failure>
    );
  }
  if (!checked) return <PageSkeleton />;
  const { report } = checked;
  if (checked.state === "confirmed") {
    return (
      <EmptyState
        icon={<IconCircleCheck size={48} stroke={1.25} />}
        title="This import has become a recording"
        action={
          <Button component={Link} to={checked.sequence_id ? `/recordings/${checked.sequence_id}` : "/recordings"}>
            Open the recording
          </Button>
        }
      >
        Its report stands on the recording's page.
      </EmptyState>
    );
  }
  const discard = async (): Promise<void> => {
    await discardImport(importId).catch(() => undefined);
    void navigate("/recordings");
  };
  return (
    <div className="page" style={{ maxWidth: 1120 }}>
      <Group justify="space-between" mb="lg" align="flex-start" wrap="nowrap">
        <div>
          <Title order={1}>Import report</Title>
          <Text className="quiet" mt={4}>
            {formatCount(checked.file_count, "file")}, {formatBytes(checked.byte_count)}.{" "}
            {report.ok
              ? `Read as: ${formatFileFormat(report.format)}. Nothing is stored until you say so.`
              : stillNeeded(report.questions ?? []).length > 0
                ? `Read as: ${formatFileFormat(report.format)}. Some information is missing. Nothing is stored until you say so.`
                : "This cannot be imported as it is. Nothing was stored."}
          </Text>
        </div>
        <Button variant="default" onClick={() => void discard()}>
          Discard
        </Button>
      </Group>
      <Checked key={checked.id} checked={checked} />
    </div>
  );
}
