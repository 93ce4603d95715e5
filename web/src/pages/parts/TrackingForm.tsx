import { Button, Collapse, SimpleGrid, Skeleton } from "@mantine/core";
import { useState } from "react";
import { useJobForm } from "../../api/jobs";
import type { FormField, Recording } from "../../api/types";
import { choosePreset, matchPreset, type Changed } from "../../model/presets";
import { Failure } from "./Failure";
import { JobField } from "./JobField";
import { PresetChoice } from "./PresetChoice";

/** What somebody chose for a tracking job; the preset that forms begin with until they touch anything. */
export function useTrackingOptions(isOpen: boolean) {
  const form = useJobForm(isOpen);
  const [touched, setTouched] = useState<Changed | null>(null);
  const usual = form.data?.presets.find((preset) => preset.name === form.data.usual_preset);
  const changed: Changed = touched ?? (form.data && usual ? choosePreset(form.data, {}, usual) : {});
  return { form, changed, setTouched };
}

interface TrackingFormProps {
  options: ReturnType<typeof useTrackingOptions>;
  recording: Recording;
  /** For several recordings: what belongs to one of them, such as its frames, is left out. */
  isForSeveral?: boolean;
}

/** Preset and fields of a tracking job; fields, defaults and help come from the server. */
export function TrackingForm({ options: { form, changed, setTouched }, recording, isForSeveral = false }: TrackingFormProps) {
  const [isAllShown, setAllShown] = useState(false);
  const fields = (form.data?.fields ?? []).filter((field) => !isForSeveral || field.about !== "recording");
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
    <>
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
      <SimpleGrid cols={{ base: 1, sm: 2 }} spacing="md">
        {fields.filter((field) => !field.is_advanced && field.type !== "boolean").map(show)}
      </SimpleGrid>
      <SimpleGrid cols={{ base: 1, sm: 3 }} spacing="md">
        {fields.filter((field) => !field.is_advanced && field.type === "boolean").map(show)}
      </SimpleGrid>
      {advanced.length > 0 && (
        <>
          <Button variant="subtle" size="compact-sm" onClick={() => setAllShown(!isAllShown)} aria-expanded={isAllShown} style={{ alignSelf: "flex-start" }}>
            {isAllShown ? "Fewer parameters" : "All parameters"}
          </Button>
          <Collapse expanded={isAllShown}>
            <SimpleGrid cols={{ base: 1, sm: 2 }} spacing="md">
              {advanced.map(show)}
            </SimpleGrid>
          </Collapse>
        </>
      )}
    </>
  );
}
