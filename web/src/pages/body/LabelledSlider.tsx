import { Group, Slider, Text } from "@mantine/core";

interface LabelledSliderProps {
  label: string;
  unit: string;
  least: number;
  most: number;
  step: number;
  value: number;
  onChange: (value: number) => void;
}

/** A slider with its name and its value above it. */
export function LabelledSlider({ label, unit, least, most, step, value, onChange }: LabelledSliderProps) {
  return (
    <div>
      <Group justify="space-between">
        <Text size="xs">{label}</Text>
        <Text size="xs" className="quiet">
          {step < 1 ? value.toFixed(1) : value}
          {unit === "°" ? unit : ` ${unit}`}
        </Text>
      </Group>
      <Slider size="sm" min={least} max={most} step={step} label={null} thumbLabel={`${label}, ${unit === "sd" ? "standard deviations" : "degrees"}`} value={value} onChange={onChange} />
    </div>
  );
}
