import { Button, Group, Modal, Stack, Text, Title } from "@mantine/core";
import { useNavigate } from "react-router";
import { useStartTracking } from "../../api/jobs";
import type { Recording } from "../../api/types";
import { TrackingForm, useTrackingOptions } from "./TrackingForm";

interface StartTrackingProps {
  recording: Recording;
  isOpen: boolean;
  onClose: () => void;
}

/** Start a tracking job: the fields, defaults and help come from the server. */
export function StartTracking({ recording, isOpen, onClose }: StartTrackingProps) {
  const options = useTrackingOptions(isOpen);
  const start = useStartTracking();
  const navigate = useNavigate();

  const submit = (): void =>
    start.mutate(
      { sequenceId: recording.id, params: options.changed },
      {
        onSuccess: (job) => {
          onClose();
          options.setTouched(null);
          void navigate(`/jobs/${job.id}`);
        },
      },
    );
  return (
    <Modal opened={isOpen} onClose={onClose} size={760} title={<Title order={2}>Track {recording.name}</Title>}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          submit();
        }}
      >
        <Stack gap="md">
          <Text size="sm" className="quiet">
            A hand is fitted to every frame. It starts from the annotation of the first frame when there is one, otherwise from the depth alone. You can go on
            working meanwhile, and close the browser.
          </Text>
          <TrackingForm options={options} recording={recording} />
          {start.error && (
            <Text size="sm" c="var(--bad-text)" role="alert">
              {start.error.message} No job was started.
            </Text>
          )}
          <Group justify="flex-end" gap="sm">
            <Button variant="default" onClick={onClose}>
              Cancel
            </Button>
            <Button type="submit" loading={start.isPending} data-autofocus>
              Start tracking
            </Button>
          </Group>
        </Stack>
      </form>
    </Modal>
  );
}
