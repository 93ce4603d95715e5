import { Button, Group, Slider, Stack, Text } from "@mantine/core";
import { IconSun } from "@tabler/icons-react";
import { useHint } from "../../state/keys";
import { clampFactor } from "../../state/viewOptions";
import { useAnnotating } from "./annotating";
import { useOption } from "./reading";
import { ToolPopover } from "./ToolPopover";

const FACTORS = [
  ["brightness", "Brightness", "view.brighter"],
  ["contrast", "Contrast", "view.contrastUp"],
] as const;

export function BrightnessTool() {
  const { setOptions } = useAnnotating();
  const factors = { brightness: useOption("brightness"), contrast: useOption("contrast") };
  const hint = useHint();
  const isAdjusted = factors.brightness !== 1 || factors.contrast !== 1;
  return (
    <ToolPopover label="Brightness and contrast" icon={<IconSun size={18} />} isOn={isAdjusted}>
      {() => (
        <Stack gap="sm">
          {FACTORS.map(([name, label, id]) => (
            <div key={name}>
              <Group justify="space-between" mb={4}>
                <Text size="xs">{hint(label, id)}</Text>
                <Text size="xs" className="quiet">
                  {factors[name].toFixed(2)}
                </Text>
              </Group>
              <Slider aria-label={label} thumbLabel={label} min={0.25} max={4} step={0.05} value={factors[name]} onChange={(value) => setOptions({ [name]: clampFactor(value) })} label={null} />
            </div>
          ))}
          <Button size="xs" variant="default" disabled={!isAdjusted} onClick={() => setOptions({ brightness: 1, contrast: 1 })}>
            As recorded
          </Button>
        </Stack>
      )}
    </ToolPopover>
  );
}
