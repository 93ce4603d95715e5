import { Button, Group, Stack, Text, TextInput, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconCircleCheck } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { discardImport, useCheckAgain, useConfirmImport, useImport, type ImportOptions } from "../api/imports";
import type { Import } from "../api/types";
import { formatBytes, formatCount, formatName } from "../model/format";
import { EmptyState } from "./parts/EmptyState";
import { Failure } from "./parts/Failure";
import { ImportFacts } from "./parts/ImportFacts";
import { ImportOptionsForm } from "./parts/ImportOptionsForm";
import { PageSkeleton } from "./parts/PageSkeleton";
import { Sentences } from "./parts/Sentences";
import { useTitle } from "./parts/useTitle";

function Confirm({ checked }: { checked: Import }) {
  const [name, setName] = useState(checked.name);
  const confirm = useConfirmImport(checked.id);
  const navigate = useNavigate();
  const store = (): void =>
    confirm.mutate(name.trim(), {
      onSuccess: (recording) => {
        notifications.show({ message: `${recording.name} was imported.`, color: "teal" });
        void navigate(`/recordings/${recording.id}`, { replace: true });
      },
    });
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        store();
      }}
    >
      <Group align="flex-end" gap="sm">
        <TextInput label="Name of the recording" value={name} onChange={(event) => setName(event.currentTarget.value)} maxLength={200} required flex={1} />
        <Button type="submit" loading={confirm.isPending} disabled={!name.trim()} leftSection={<IconCircleCheck size={16} aria-hidden />}>
          Store the recording
        </Button>
      </Group>
      {confirm.error && (
        <Text size="sm" mt="sm" c="var(--bad-text)" role="alert">
          {confirm.error.message} Nothing was stored; try again.
        </Text>
      )}
    </form>
  );
}

/** What was found in an import, before anything is stored; the address can be sent to a colleague. */
export function ImportPage() {
  const { importId = "" } = useParams();
  const { data: checked, error, refetch } = useImport(importId);
  const again = useCheckAgain(importId);
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
    <div className="page" style={{ maxWidth: 1040 }}>
      <Group justify="space-between" mb="lg" align="flex-start" wrap="nowrap">
        <div>
          <Title order={1}>Import report</Title>
          <Text className="quiet" mt={4}>
            {formatCount(checked.file_count, "file")}, {formatBytes(checked.byte_count)}.{" "}
            {report.ok
              ? `Read as: ${formatName(report.format).toLowerCase()}. Nothing is stored until you say so.`
              : "This cannot be imported as it is. Nothing was stored."}
          </Text>
        </div>
        <Button variant="default" onClick={() => void discard()}>
          Discard
        </Button>
      </Group>
      <Stack gap="md">
        <Sentences title={report.problems.length === 1 ? "One thing must be mended" : `${report.problems.length} things must be mended`} sentences={report.problems} isProblem />
        <Sentences title="Worth knowing" sentences={report.warnings} isProblem={false} />
        {report.ok && <div className="card" style={{ padding: 16 }}><Confirm key={checked.name} checked={checked} /></div>}
        {report.ok && <ImportFacts report={report} />}
        <ImportOptionsForm
          options={checked.options as ImportOptions}
          problems={report.problems}
          isOpen={!report.ok}
          isBusy={again.isPending}
          failure={again.error}
          onCheck={(options) => again.mutate(options, { onSuccess: () => document.getElementById("main")?.scrollTo({ top: 0 }) })}
        />
        {!report.ok && report.cameras.length > 0 && <ImportFacts report={report} />}
      </Stack>
    </div>
  );
}
