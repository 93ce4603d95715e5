import { Box, Button, Text, Title } from "@mantine/core";
import { IconUpload } from "@tabler/icons-react";
import { useEffect } from "react";
import { Link, useNavigate } from "react-router";
import { cancelIncoming, sendIncoming, useIncoming } from "../../state/incoming";
import { formatBytes, formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ImportButton } from "../parts/ImportButton";
import { Sending } from "../parts/Sending";
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
  const sent = incoming.sent ?? 0;
  const isChecking = sent >= 1;
  const cancel = (): void => {
    cancelIncoming();
    void navigate("/recordings");
  };
  return (
    <div className="page">
      <Box maw={640} mx="auto" mt={64} className="card" p="xl">
        <Sending sent={sent} title={<Title order={2}>{isChecking ? "Checking the files" : "Sending the files"}</Title>} onCancel={cancel}>
          <Text className="quiet">
            {formatCount(incoming.files.length, "file")}, {formatBytes(incoming.bytes)}.{" "}
            {isChecking ? "Every image is opened and checked; nothing is stored yet." : "Stay on any page of the studio until they have arrived."}
          </Text>
        </Sending>
      </Box>
    </div>
  );
}
