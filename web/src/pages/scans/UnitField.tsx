import { Group, NumberInput, Select } from "@mantine/core";
import { useState } from "react";
import { UNITS } from "../../model/scanUnit";

interface UnitFieldProps {
  /** Metres per unit; null while nobody said one and none is proposed. */
  value: number | null;
  /** Longest side of the scan that is shown, in units of its file. */
  units: number | null;
  onChange: (metres: number) => void;
  description?: string;
}

const OTHER = "other";
const rounded = (value: number, digits: number): number => Number(value.toPrecision(digits));

/** The unit of a scan's file: one of the usual ones, or any; or how long the scan is, which gives it. */
export function UnitField({ value, units, onChange, description }: UnitFieldProps) {
  const usual = UNITS.find(({ metres }) => metres === value);
  const [isOther, setOther] = useState(false);
  const kind = value === null && !isOther ? null : usual && !isOther ? String(usual.metres) : OTHER;
  const take = (metres: string | number): void => {
    if (typeof metres === "number" && metres > 0) onChange(metres);
  };
  return (
    <Group grow preventGrowOverflow={false} gap="md" align="flex-end">
      <Select
        miw={144}
        label="Unit of the files"
        description={description}
        placeholder="Choose"
        data={[...UNITS.map(({ label, metres }) => ({ value: String(metres), label })), { value: OTHER, label: "Another" }]}
        value={kind}
        allowDeselect={false}
        onChange={(chosen) => {
          setOther(chosen === OTHER);
          if (chosen !== OTHER && chosen !== null) onChange(Number(chosen));
        }}
      />
      {kind === OTHER && (
        <NumberInput miw={112} label="1 unit is, in mm" min={0} decimalScale={6} hideControls value={value === null ? "" : rounded(1000 * value, 6)} onChange={(mm) => take(typeof mm === "number" ? mm / 1000 : mm)} data-autofocus />
      )}
      {kind === OTHER && units !== null && (
        <NumberInput miw={112} label="or the scan’s length, in cm" min={0} decimalScale={2} hideControls value={value === null ? "" : rounded(100 * value * units, 4)} onChange={(cm) => take(typeof cm === "number" ? rounded(cm / 100 / units, 5) : cm)} />
      )}
    </Group>
  );
}
