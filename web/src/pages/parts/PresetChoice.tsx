import { Group, Radio, SimpleGrid, Text } from "@mantine/core";
import type { Preset } from "../../api/types";
import { formatNumber } from "../../model/format";
import classes from "./PresetChoice.module.css";

interface PresetChoiceProps {
  presets: readonly Preset[];
  /** Null for one's own values. */
  chosen: Preset | null;
  onChoose: (preset: Preset) => void;
}

/** Presets as cards with what each is for and what it costs; "Custom" where the fields say something else. */
export function PresetChoice({ presets, chosen, onChoose }: PresetChoiceProps) {
  return (
    <Radio.Group
      label={
        <Group gap="sm" component="span">
          Preset
          <Text span size="sm" fw={400} className="quiet" role="status">
            {chosen ? chosen.label : "Custom: the fields below are your own"}
          </Text>
        </Group>
      }
      labelProps={{ component: "div" }}
      value={chosen?.name ?? ""}
      onChange={(name) => {
        const preset = presets.find((one) => one.name === name);
        if (preset) onChoose(preset);
      }}
    >
      <SimpleGrid cols={{ base: 1, sm: 2 }} spacing="sm" mt="xs">
        {presets.map((preset) => (
          <Radio.Card key={preset.name} value={preset.name} className={classes.card} aria-label={preset.label}>
            <Group gap="sm" wrap="nowrap" mb={4}>
              <Radio.Indicator size="xs" />
              <Text fw={600}>{preset.label}</Text>
            </Group>
            <Text size="xs">{preset.help}</Text>
            <Text size="xs" className={classes.cost}>
              One hand {formatNumber(preset.one_hand_ms, 0)} ms a frame, two hands and an object {formatNumber(preset.two_hands_and_object_ms, 0)} ms
            </Text>
          </Radio.Card>
        ))}
      </SimpleGrid>
      <Text size="xs" className={classes.cost}>
        Times are of one processor core and images of depth alone. Where there is colour, the hand detector adds 20 to 30 ms.
      </Text>
    </Radio.Group>
  );
}
