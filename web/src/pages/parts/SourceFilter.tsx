import { Button, Checkbox, Popover, Radio, Stack, Text } from "@mantine/core";
import { IconFilter } from "@tabler/icons-react";
import { ALL_SOURCES, INDEPENDENT, SOURCE_CHOICES } from "../../model/source";

interface SourceFilterProps {
  chosen: readonly string[];
  onChange: (chosen: readonly string[]) => void;
}

/** Which joints count, by where they came from: those no track had a part in, all, or some kinds. */
export function SourceFilter({ chosen, onChange }: SourceFilterProps) {
  const [first = INDEPENDENT] = chosen;
  const way = first === INDEPENDENT || first === ALL_SOURCES ? first : "some";
  const kinds = SOURCE_CHOICES.filter((one) => chosen.includes(one.value)).map((one) => one.label);
  const words = way === INDEPENDENT ? "Independent of tracks" : way === ALL_SOURCES ? "All sources" : kinds.join(", ");
  return (
    <Popover position="bottom-start" width={304} shadow="md" trapFocus>
      <Popover.Target>
        <Button size="xs" variant="default" leftSection={<IconFilter size={16} aria-hidden />} aria-label={`Sources: ${words}`} maw={248}>
          {words}
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Radio.Group label="Joints that count" value={way} onChange={(next) => onChange(next === "some" ? ["hand"] : [next])}>
          <Stack gap={8} mt={8}>
            <Radio size="xs" value={INDEPENDENT} label="Without what a track had a part in" description="No track judges itself: neither joints accepted from a track, a model fit or the hand detector count, nor what was made of them." />
            <Radio size="xs" value={ALL_SOURCES} label="All" />
            <Radio size="xs" value="some" label="Some kinds" />
          </Stack>
        </Radio.Group>
        {way === "some" && (
          <Checkbox.Group aria-label="Kinds" value={[...chosen]} onChange={(next) => next.length > 0 && onChange(next)}>
            <Stack gap={8} mt={8} pl={28}>
              {SOURCE_CHOICES.map((one) => (
                <Checkbox key={one.value} size="xs" value={one.value} label={one.label} />
              ))}
            </Stack>
          </Checkbox.Group>
        )}
        <Text size="xs" className="quiet" mt="sm">
          A joint that somebody moves counts as placed by hand from then on.
        </Text>
      </Popover.Dropdown>
    </Popover>
  );
}
