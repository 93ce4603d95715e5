import { Button, Collapse, Group, Modal, SimpleGrid, Skeleton, Stack, Text, Title } from "@mantine/core";
import { useState } from "react";
import { useNavigate } from "react-router";
import { useJobForm, useStartTracking } from "../../api/jobs";
import type { FormField, Recording } from "../../api/types";
import { choosePreset, matchPreset, type Changed } from "../../model/presets";
import { Failure } from "./Failure";
import { JobField } from "./JobField";
import { PresetChoice } from "./PresetChoice";

interface StartTrackingProps {
  recording: Recording;
  isOpen: boolean;
  onClose: () => void;
}

/** Start a tracking job: the fields, defaults and help come from the server. */
export function StartTracking({ recording, isOpen, onClose }: StartTrackingProps) {
  const form = useJobForm(isOpen);
  const start = useStartTracking();
  const navigate = useNavigate();
  const [touched, setTouched] = useState<Changed | null>(null);
  const [isAllShown, setAllShown] = useState(false);

  const fields = form.data?.fields ?? [];
  const usual = form.data?.presets.find((preset) => preset.name === form.data.usual_preset);
  const changed: Changed = touched ?? (form.data && usual ? choosePreset(form.data, {}, usual) : {});

  const submit = (): void =>
    start.mutate(
      { sequenceId: recording.id, params: changed },
      {
        onSuccess: (job) => {
          onClose();
          setTouched(null);
          void navigate(`/jobs/${job.id}`);
        },
      },
    );
  const set = (field: FormField, value: unknown): void => {
    const { [field.name]: gone, ...others } = changed;
    void gone;
    setTouched(value === field.default || value === "" ? others : { ...others, [field.name]: value });
  };
  const show = (field: FormField) => (
    <JobField key={field.name} field={field} recording={recording} value={field.name in changed ? changed[field.name] : field.default} onChange={(value) => set(field, value)} />
  );
  const advanced = fields.filter((field) => field.is_advanced);

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
          {form.error && <Failure what="The form could not be loaded" error={form.error} onRetry={() => void form.refetch()} />}
          {form.isPending && (
            <>
              <Skeleton height={56} />
              <Skeleton height={56} />
            </>
          )}
          {form.data && (
            <PresetChoice presets={form.data.presets} chosen={matchPreset(form.data, changed)} onChoose={(preset) => setTouched(choosePreset(form.data, changed, preset))} />
          )}
          <SimpleGrid cols={2} spacing="md">
            {fields.filter((field) => !field.is_advanced && field.type !== "boolean").map(show)}
          </SimpleGrid>
          <SimpleGrid cols={3} spacing="md">
            {fields.filter((field) => !field.is_advanced && field.type === "boolean").map(show)}
          </SimpleGrid>
          {advanced.length > 0 && (
            <>
              <Button variant="subtle" size="compact-sm" onClick={() => setAllShown(!isAllShown)} aria-expanded={isAllShown} style={{ alignSelf: "flex-start" }}>
                {isAllShown ? "Fewer parameters" : "All parameters"}
              </Button>
              <Collapse expanded={isAllShown}>
                <SimpleGrid cols={2} spacing="md">
                  {advanced.map(show)}
                </SimpleGrid>
              </Collapse>
            </>
          )}
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
