import { Checkbox, NumberInput, Select, TextInput } from "@mantine/core";
import type { FormField, Recording } from "../../api/types";

interface JobFieldProps {
  field: FormField;
  recording: Recording;
  value: unknown;
  onChange: (value: unknown) => void;
}

/** One option of a tracking job, as its type and its bounds ask for. */
export function JobField({ field, recording, value, onChange }: JobFieldProps) {
  const common = { label: field.label, description: field.help };
  if (field.name === "camera") {
    const cameras = recording.cameras.filter((camera) => camera.has_depth).map((camera) => camera.id);
    const first = cameras[0] ?? "none";
    return <Select {...common} description={undefined} data={[{ value: "", label: `The first with depth (${first})` }, ...cameras]} value={String(value)} allowDeselect={false} onChange={onChange} />;
  }
  if (field.choices) {
    const data = field.choices.map((choice, place) => ({ value: choice, label: field.choice_labels?.[place] ?? choice }));
    return <Select {...common} data={data} value={String(value)} allowDeselect={false} onChange={onChange} />;
  }
  if (field.type === "boolean") {
    return <Checkbox {...common} checked={Boolean(value)} onChange={(event) => onChange(event.currentTarget.checked)} />;
  }
  if (field.type !== "text") {
    const isFrame = field.name === "first_frame" || field.name === "last_frame";
    const isToTheEnd = field.name === "last_frame" && value === -1;
    const last = recording.frame_count - 1;
    return (
      <NumberInput
        {...common}
        description={field.name === "last_frame" ? "Last frame to track; empty is the recording's last." : field.help}
        value={isToTheEnd ? "" : ((value as number | null) ?? "")}
        placeholder={isToTheEnd ? String(last) : undefined}
        allowDecimal={field.type === "number"}
        allowNegative={false}
        suffix={field.unit ? ` ${field.unit}` : undefined}
        min={isFrame ? 0 : (field.low ?? undefined)}
        max={isFrame ? last : (field.high ?? undefined)}
        onChange={onChange}
      />
    );
  }
  return <TextInput {...common} value={(value as string | null) ?? ""} onChange={(event) => onChange(event.currentTarget.value)} />;
}
