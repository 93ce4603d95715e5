import { Alert, Button, Group, List, Stack, Text, TextInput, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconAlertTriangle, IconCircleCheck, IconCircleX } from "@tabler/icons-react";
import { useState } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { discardImport, useCheckAgain, useConfirmImport, useImport } from "../api/imports";
import type { Import } from "../api/types";
import { Failure } from "./parts/Failure";
import { ImportFacts } from "./parts/ImportFacts";
import { ImportOptionsForm } from "./parts/ImportOptionsForm";
import { PageSkeleton } from "./parts/PageSkeleton";
import { useTitle } from "./parts/useTitle";

function Sentences({ title, sentences, isProblem }: { title: string; sentences: readonly string[]; isProblem: boolean }) {
  if (sentences.length === 0) return null;
  const Icon = isProblem ? IconCircleX : IconAlertTriangle;
  return (
    <Alert color={isProblem ? "red" : "yellow"} icon={<Icon size={20} aria-hidden />} title={title} variant="light">
      <List size="sm" spacing={4}>
        {sentences.map((sentence) => (
          <List.Item key={sentence} style={{ overflowWrap: "anywhere" }}>
            {sentence}
          </List.Item>
        ))}
      </List>
    </Alert>
  );
}

function Confirm({ checked }: { checked: Import }) {
  const suggestion = checked.report["name"];
  const [name, setName] = useState(typeof suggestion === "string" ? suggestion : "");
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
            {report.ok ? "These files make a recording. Nothing is stored until you say so." : "These files cannot be imported as they are. Nothing was stored."}
          </Text>
        </div>
        <Button variant="default" onClick={() => void discard()}>
          Discard
        </Button>
      </Group>
      <Stack gap="md">
        <Sentences title={report.problems.length === 1 ? "One thing must be mended" : `${report.problems.length} things must be mended`} sentences={report.problems} isProblem />
        <Sentences title="Worth knowing" sentences={report.warnings} isProblem={false} />
        {report.ok && <div className="card" style={{ padding: 16 }}><Confirm key={String(report["name"])} checked={checked} /></div>}
        <ImportFacts report={report} />
        <ImportOptionsForm report={report} isOpen={!report.ok} isBusy={again.isPending} failure={again.error} onCheck={(options) => again.mutate(options)} />
      </Stack>
    </div>
  );
}
