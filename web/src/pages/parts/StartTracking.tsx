import { Button, Checkbox, Collapse, Group, Modal, NumberInput, Select, SimpleGrid, Skeleton, Stack, Text, TextInput, Title } from "@mantine/core";
import { useState } from "react";
import { useNavigate } from "react-router";
import { useJobForm, useStartTracking } from "../../api/jobs";
import type { FormField, Recording } from "../../api/types";
import { formatName } from "../../model/format";
import { Failure } from "./Failure";

interface StartTrackingProps {
  recording: Recording;
  isOpen: boolean;
  onClose: () => void;
}

/** Fields most people set; the others are one click away. */
const USUAL = ["first_frame", "last_frame", "iterations", "calibrate"];

interface FieldProps {
  field: FormField;
  value: unknown;
  onChange: (value: unknown) => void;
}

function Field({ field, value, onChange }: FieldProps) {
  const label = formatName(field.name);
  if (field.choices) {
    return <Select label={label} description={field.help} data={field.choices} value={String(value)} allowDeselect={false} onChange={onChange} />;
  }
  if (field.type === "boolean") {
    return <Checkbox label={label} description={field.help} checked={Boolean(value)} onChange={(event) => onChange(event.currentTarget.checked)} />;
  }
  if (field.type !== "text") {
    return (
      <NumberInput
        label={label}
        description={field.help}
        value={(value as number | null) ?? ""}
        allowDecimal={field.type === "number"}
        onChange={onChange}
      />
    );
  }
  return <TextInput label={label} description={field.help} value={(value as string | null) ?? ""} onChange={(event) => onChange(event.currentTarget.value)} />;
}

/** Start a tracking job: the fields, defaults and help come from the server. */
export function StartTracking({ recording, isOpen, onClose }: StartTrackingProps) {
  const form = useJobForm(isOpen);
  const start = useStartTracking();
  const navigate = useNavigate();
  const [changed, setChanged] = useState<Record<string, unknown>>({});
  const [isAllShown, setAllShown] = useState(false);

  const submit = (): void =>
    start.mutate(
      { sequenceId: recording.id, params: changed },
      {
        onSuccess: (job) => {
          onClose();
          setChanged({});
          void navigate(`/jobs/${job.id}`);
        },
      },
    );
  const set = (field: FormField, value: unknown): void =>
    setChanged((now) => {
      const { [field.name]: gone, ...others } = now;
      void gone;
      return value === field.default || value === "" ? others : { ...others, [field.name]: value };
    });
  const show = (field: FormField) => (
    <Field key={field.name} field={field} value={field.name in changed ? changed[field.name] : field.default} onChange={(value) => set(field, value)} />
  );
  const usual = form.data?.filter((field) => USUAL.includes(field.name)) ?? [];
  const rest = form.data?.filter((field) => !USUAL.includes(field.name)) ?? [];

  return (
    <Modal opened={isOpen} onClose={onClose} size="lg" title={<Title order={2}>Track {recording.name}</Title>}>
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
          <SimpleGrid cols={2} spacing="md">
            {usual.map(show)}
          </SimpleGrid>
          {rest.length > 0 && (
            <>
              <Button variant="subtle" size="compact-sm" onClick={() => setAllShown(!isAllShown)} aria-expanded={isAllShown} style={{ alignSelf: "flex-start" }}>
                {isAllShown ? "Fewer parameters" : "All parameters"}
              </Button>
              <Collapse expanded={isAllShown}>
                <SimpleGrid cols={2} spacing="md">
                  {rest.map(show)}
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
