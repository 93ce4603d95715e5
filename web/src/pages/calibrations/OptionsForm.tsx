import { Checkbox, NumberInput, SimpleGrid, Stack, Title } from "@mantine/core";
import type { CalibrationOptions } from "../../api/calibrations";
import classes from "./calibrations.module.css";

interface OptionsFormProps {
  options: CalibrationOptions;
  onChange: (options: CalibrationOptions) => void;
}

/** What is known of the cameras' clocks. */
export function OptionsForm({ options, onChange }: OptionsFormProps) {
  const set = (change: Partial<CalibrationOptions>): void => onChange({ ...options, ...change });
  return (
    <Stack gap="md" className={`card ${classes.card}`} component="section" aria-label="Time">
      <Title order={2}>Time</Title>
      <Checkbox
        label="Find how far the videos are out of step"
        description="Without it, frames with the same number show the same moment: for cameras with a common trigger"
        checked={options.find_offsets}
        onChange={(event) => set({ find_offsets: event.currentTarget.checked })}
      />
      <SimpleGrid cols={{ base: 1, sm: 3 }} spacing="md">
        <NumberInput label="Largest offset, s" value={options.max_offset_s} min={0} max={600} clampBehavior="strict" disabled={!options.find_offsets} onChange={(value) => typeof value === "number" && set({ max_offset_s: value })} />
        <NumberInput label="Images a second" placeholder="not known" value={options.fps ?? ""} min={0.001} max={100_000} onChange={(value) => set({ fps: typeof value === "number" && value > 0 ? value : null })} />
        <NumberInput label="Left out for judging, %" value={Math.round(100 * options.left_out)} min={0} max={50} allowDecimal={false} clampBehavior="strict" onChange={(value) => typeof value === "number" && set({ left_out: value / 100 })} />
      </SimpleGrid>
    </Stack>
  );
}
