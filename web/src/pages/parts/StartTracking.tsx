import { Button, Modal, Stack, Text, Title } from "@mantine/core";
import { useNavigate } from "react-router";
import { useStartTracking } from "../../api/jobs";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import type { Recording } from "../../api/types";
import { FormFooter } from "./Obstacles";
import { TrackingForm, useTrackingOptions } from "./TrackingForm";

interface StartTrackingProps {
  recording: Recording;
  isOpen: boolean;
  onClose: () => void;
}

/** What the tracker begins with, to follow "It starts". */
export const whereItStarts = (recording: Recording): string =>
  `from the annotation of the first frame when there is one, otherwise from ${recording.cameras.some((camera) => camera.has_depth) ? "the depth alone" : "the hand that is found in the pictures"}.`;

/** Start a tracking job: the fields, defaults and help come from the server. */
export function StartTracking({ recording, isOpen, onClose }: StartTrackingProps) {
  const options = useTrackingOptions(isOpen);
  const start = useStartTracking();
  const navigate = useNavigate();
  const check = useJobCheck("/jobs", { sequence_id: recording.id, params: options.changed }, isOpen);

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
            A hand is fitted to every frame. It starts {whereItStarts(recording)} You can go on working meanwhile, and close the browser.
          </Text>
          <TrackingForm options={options} recording={recording} />
          <FormFooter check={check.data} failure={start.error}>
            <Button variant="default" onClick={onClose}>
              Cancel
            </Button>
            <Button type="submit" loading={start.isPending} disabled={!mayStart(check)} data-autofocus>
              Start tracking
            </Button>
          </FormFooter>
        </Stack>
      </form>
    </Modal>
  );
}
