import { Button, Popover, Select, Stack, Text } from "@mantine/core";
import { IconTags } from "@tabler/icons-react";
import type { Comparison } from "../../api/evaluations";
import { useSnapshots } from "../../api/labels";
import { formatCount } from "../../model/format";

interface LabelsPickerProps {
  comparison: Comparison;
  snapshots: readonly string[];
  onChange: (snapshots: string[]) => void;
}

/** Which labels judge: those of now, or for each recording a snapshot that never changes. */
export function LabelsPicker({ comparison, snapshots, onChange }: LabelsPickerProps) {
  const recordings = [...new Map(comparison.tracks.map((track) => [track.recording_key, track.recording]))];
  const [only] = recordings;
  if (!only) return null;
  if (recordings.length === 1) return <RecordingLabels recording={only[0]} label="" chosen={snapshots} onChange={onChange} />;
  return (
    <Popover position="bottom-end" width={320} shadow="md" trapFocus>
      <Popover.Target>
        <Button size="xs" variant="default" leftSection={<IconTags size={16} aria-hidden />}>
          {snapshots.length === 0 ? "Current labels" : `Labels of ${formatCount(snapshots.length, "snapshot")}`}
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="sm">
          <Text size="xs" className="quiet">
            A snapshot never changes, so neither does what is judged by it.
          </Text>
          {recordings.map(([id, name]) => (
            <RecordingLabels key={id} recording={id} label={name} chosen={snapshots} onChange={onChange} />
          ))}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}

function RecordingLabels({ recording, label, chosen, onChange }: { recording: string; label: string; chosen: readonly string[]; onChange: (snapshots: string[]) => void }) {
  const { data, error } = useSnapshots(recording);
  const own = data ?? [];
  const value = own.find((one) => chosen.includes(one.id))?.id ?? "";
  const others = chosen.filter((id) => own.every((one) => one.id !== id));
  return (
    <Select
      size="xs"
      w={label ? "100%" : 224}
      {...(label ? { label } : { "aria-label": "Labels that judge" })}
      allowDeselect={false}
      disabled={!data}
      error={error ? "The snapshots could not be loaded" : undefined}
      comboboxProps={{ withinPortal: !label }}
      data={[{ value: "", label: own.length === 0 && data ? "Current labels (no snapshot yet)" : "Current labels" }, ...own.map((one) => ({ value: one.id, label: `Snapshot ${one.version}: ${one.name}` }))]}
      value={value}
      onChange={(id) => onChange(id ? [...others, id] : others)}
    />
  );
}
