import { Button, Checkbox, Collapse, Group, NumberInput, SegmentedControl, Select, SimpleGrid, Stack, Text, TextInput, Title, UnstyledButton } from "@mantine/core";
import { IconChevronDown, IconChevronRight } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { useImportFormats, type ImportOptions } from "../../api/imports";
import { formatName } from "../../model/format";
import classes from "./ImportOptionsForm.module.css";

interface ImportOptionsFormProps {
  /** What has been said so far. */
  options: ImportOptions;
  /** Sentences that name the options that are missing. */
  problems: readonly string[];
  /** Open from the start, because something has to be said. */
  isOpen: boolean;
  isBusy: boolean;
  failure: Error | null;
  onCheck: (options: ImportOptions) => void;
}

type NumberName = "fx" | "fy" | "cx" | "cy" | "fps" | "depth_scale" | "world_unit_m";

const NUMBERS: readonly { name: NumberName; label: string; help: string; step: number }[] = [
  { name: "fx", label: "fx", help: "Focal length along x, px", step: 1 },
  { name: "fy", label: "fy", help: "Focal length along y, px", step: 1 },
  { name: "cx", label: "cx", help: "Principal point x, px", step: 1 },
  { name: "cy", label: "cy", help: "Principal point y, px", step: 1 },
  { name: "fps", label: "Frames per second", help: "30 for most depth cameras", step: 1 },
  { name: "depth_scale", label: "Depth unit, m", help: "depth_scale: 0.001 for millimetres", step: 0.001 },
  { name: "world_unit_m", label: "Calibration unit, m", help: "world_unit_m: 0.001 for mm", step: 0.001 },
];

const HANDS: Record<string, string[]> = { right: ["right"], left: ["left"], both: ["right", "left"] };

/** What files don't say themselves: intrinsics, units, where images lie. */
export function ImportOptionsForm({ options: said, problems, isOpen, isBusy, failure, onCheck }: ImportOptionsFormProps) {
  const [isShown, setShown] = useState(isOpen);
  const [options, setOptions] = useState<ImportOptions>(said);
  useEffect(() => setShown(isOpen), [isOpen]);
  const set = (change: Partial<ImportOptions>): void => setOptions((now) => ({ ...now, ...change }));
  const hands = Object.keys(HANDS).find((key) => HANDS[key]?.join() === options.hands?.join()) ?? "right";
  const isNeeded = (name: string): boolean => problems.some((problem) => new RegExp(`\\b${name}\\b`).test(problem));
  const formats = useImportFormats().data ?? [];
  const Chevron = isShown ? IconChevronDown : IconChevronRight;

  const check = (): void => {
    const known = Object.entries(options).filter(([, value]) => value !== undefined && value !== "" && value !== null);
    onCheck(Object.fromEntries(known) as ImportOptions);
  };

  return (
    <section className="card" style={{ padding: 16 }} aria-label="What the files do not say">
      <UnstyledButton onClick={() => setShown(!isShown)} aria-expanded={isShown} w="100%">
        <Group gap="sm">
          <Chevron size={18} aria-hidden />
          <Title order={2}>What the files do not say</Title>
        </Group>
      </UnstyledButton>
      <Collapse expanded={isShown}>
        <form
          onSubmit={(event) => {
            event.preventDefault();
            check();
          }}
        >
          <Stack gap="md" pt="md">
            <Text className="quiet" size="sm">
              Fill in what you know and look again; what is empty is found out from the files where that is possible. What the report asks for is marked.
            </Text>
            <SimpleGrid cols={4} spacing="md">
              {NUMBERS.map(({ name, label, help, step }) => (
                <NumberInput
                  key={name}
                  name={name}
                  label={label}
                  description={help}
                  value={options[name] ?? ""}
                  step={step}
                  withAsterisk={isNeeded(name)}
                  className={isNeeded(name) ? classes.needed : undefined}
                  hideControls
                  onChange={(value) => set({ [name]: typeof value === "number" ? value : undefined })}
                />
              ))}
              <Select
                label="Format"
                description="Recognised when empty"
                data={formats.map((value) => ({ value, label: formatName(value) }))}
                value={options.format ?? null}
                clearable
                onChange={(format) => set({ format: format ?? "" })}
              />
            </SimpleGrid>
            <SimpleGrid cols={2} spacing="md">
              <TextInput
                label="Depth images"
                description="Such as depth/depth_*.png"
                value={options.depth_pattern ?? ""}
                onChange={(event) => set({ depth_pattern: event.currentTarget.value })}
              />
              <TextInput
                label="Colour images"
                description="Such as color/*.png, or none"
                value={options.color_pattern ?? ""}
                onChange={(event) => set({ color_pattern: event.currentTarget.value })}
              />
            </SimpleGrid>
            <Group justify="space-between">
              <Group gap="md">
                <Text size="sm">Hands seen</Text>
                <SegmentedControl aria-label="Hands seen" value={hands} data={Object.keys(HANDS)} onChange={(key) => set({ hands: HANDS[key] ?? ["right"] })} />
                <Checkbox label="Import although frames are missing" checked={options.allow_gaps ?? false} onChange={(event) => set({ allow_gaps: event.currentTarget.checked || undefined })} />
              </Group>
              <Button type="submit" variant={isOpen ? "filled" : "default"} loading={isBusy}>
                Look again
              </Button>
            </Group>
            {failure && (
              <Text size="sm" c="var(--bad-text)" role="alert">
                {failure.message}
              </Text>
            )}
          </Stack>
        </form>
      </Collapse>
    </section>
  );
}
