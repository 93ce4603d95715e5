import { Text } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { useNavigate } from "react-router";
import { mayStart, useJobCheck } from "../../api/jobChecks";
import { useStartJob } from "../../api/startJob";
import type { Recording } from "../../api/types";
import { TrackingForm, useTrackingOptions } from "../parts/TrackingForm";

interface StartTrackingProps {
  recording: Recording;
  isOpen: boolean;
  onClose: () => void;
}

/** What the tracker begins with, to follow "It starts". */
export const whereItStarts = (recording: Recording): string =>
  `from the annotation of the first frame when there is one, otherwise from ${recording.cameras.some((camera) => camera.has_color) ? "the hands that are found in the pictures" : "the depth alone"}.`;

/** Start a tracking job: the fields, defaults and help come from the server. */
export function StartTracking({ recording, isOpen, onClose }: StartTrackingProps) {
  const options = useTrackingOptions(isOpen);
  const start = useStartJob();
  const navigate = useNavigate();
  const wish = { kind: "track" as const, sequence_id: recording.id, params: options.changed };
  const check = useJobCheck(wish, isOpen);

  const submit = (): void =>
    start.mutate(wish, {
      onSuccess: (job) => {
        onClose();
        options.setTouched(null);
        void navigate(`/jobs/${job.id}`);
      },
    });
  return (
    <FormDialog title={`Track ${recording.name}`} size={760} isOpen={isOpen} onClose={onClose} onSubmit={submit} verb="Start tracking" isFocused isBusy={start.isPending} isReady={mayStart(check)} check={check.data} failure={start.error}>
      <Text size="sm" className="quiet">
        A hand is fitted to every frame. It starts {whereItStarts(recording)} You can go on working meanwhile, and close the browser.
      </Text>
      <TrackingForm options={options} recording={recording} />
    </FormDialog>
  );
}
