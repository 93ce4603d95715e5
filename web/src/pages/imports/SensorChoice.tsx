import { Button, Group, Select, Text } from "@mantine/core";
import type { SensorFit } from "../../api/types";
import classes from "./SensorChoice.module.css";

interface SensorChoiceProps {
  sensors: readonly SensorFit[];
  /** Its name, or null. */
  chosen: string | null;
  /** The camera is not told yet: offer the guess. */
  isOpen: boolean;
  onChoose: (sensor: SensorFit | null) => void;
}

/** A kind of depth camera whose typical values fill the fields; the likeliest one is offered, never taken by itself. */
export function SensorChoice({ sensors, chosen, isOpen, onChoose }: SensorChoiceProps) {
  const sensor = sensors.find(({ name }) => name === chosen);
  const guess = sensors.find(({ is_guess }) => is_guess);
  return (
    <div>
      <Group gap="md" align="flex-end">
        <Select
          label="Sensor"
          description="Fills the fields below with values that are typical of it"
          placeholder="None: the values are this camera's own"
          data={sensors.map(({ name, label, is_guess }) => ({ value: name, label: is_guess ? `${label} (a guess)` : label }))}
          value={chosen}
          clearable
          w={416}
          onChange={(name) => onChoose(sensors.find((one) => one.name === name) ?? null)}
        />
        {isOpen && guess && !sensor && (
          <Group gap="sm" className={classes.guess}>
            <Text size="sm">A guess, from the size of the images and the range of depth: {guess.label}.</Text>
            <Button size="xs" variant="light" onClick={() => onChoose(guess)}>
              Use its typical values
            </Button>
          </Group>
        )}
      </Group>
      {sensor && (
        <Text size="sm" mt={4} c="var(--warn-text)" role="status">
          Typical values, not this camera's calibration; from {sensor.source}.
        </Text>
      )}
    </div>
  );
}
