import { Button, Group, Loader, Progress, Stack, Text, Title } from "@mantine/core";
import { IconUpload } from "@tabler/icons-react";
import { useEffect } from "react";
import { Link, useNavigate } from "react-router";
import { cancelIncoming, sendIncoming, useIncoming } from "../../state/incoming";
import { formatBytes, formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ImportButton } from "../parts/ImportButton";
import { useTitle } from "../parts/useTitle";

/** Files on their way; when the server has looked at them, the report takes over. */
export function NewImportPage() {
  useTitle("Importing");
  const incoming = useIncoming();
  const navigate = useNavigate();
  useEffect(() => {
    if (!incoming?.result) return;
    void navigate(`/imports/${incoming.result.id}`, { replace: true });
    cancelIncoming();
  }, [incoming, navigate]);

  if (!incoming) {
    return (
      <EmptyState icon={<IconUpload size={48} stroke={1.25} />} title="Nothing is being imported" action={<ImportButton label="Choose what to import" />}>
        An upload ends when its page is closed or reloaded. Nothing was stored; drop the files again, here or on any page.
      </EmptyState>
    );
  }
  if (incoming.failure) {
    return (
      <Failure
        what="The files could not be imported"
        error={incoming.failure}
        safe="Nothing was stored, and your files are as they were."
        onRetry={() => void sendIncoming(incoming.files)}
      >
        <Button variant="default" component={Link} to="/recordings" onClick={cancelIncoming}>
          To the recordings
        </Button>
      </Failure>
    );
  }
  const isChecking = incoming.sent >= 1;
  return (
    <div className="page">
      <Stack maw={640} mx="auto" mt={64} gap="md" className="card" p="xl">
        <Group gap="sm">
          {isChecking && <Loader size="sm" />}
          <Title order={2}>{isChecking ? "Checking the files" : "Sending the files"}</Title>
        </Group>
        <Text className="quiet">
          {formatCount(incoming.files.length, "file")}, {formatBytes(incoming.bytes)}.{" "}
          {isChecking ? "Every image is opened and checked; nothing is stored yet." : "Stay on any page of the studio until they have arrived."}
        </Text>
        <Progress value={100 * incoming.sent} animated={isChecking} aria-label="Part of the files sent" />
        <Group justify="space-between">
          <Text size="sm">{isChecking ? "" : `${Math.round(100 * incoming.sent)} %`}</Text>
          <Button
            variant="default"
            onClick={() => {
              cancelIncoming();
              void navigate("/recordings");
            }}
          >
            Cancel
          </Button>
        </Group>
      </Stack>
    </div>
  );
}
