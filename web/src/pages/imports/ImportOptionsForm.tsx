import { Button, Checkbox, Collapse, Group, Loader, NumberInput, SegmentedControl, Select, SimpleGrid, Stack, Text, TextInput, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconChevronDown, IconChevronRight } from "@tabler/icons-react";
import { useImportFormats } from "../../api/imports";
import type { ImportQuestion, ImportReport } from "../../api/types";
import { formatFileFormat } from "../../model/format";
import { numberFields, withSensor } from "../../model/importForm";
import { DepthPreview } from "./DepthPreview";
import classes from "./ImportOptionsForm.module.css";
import { ObjectUnit } from "./ObjectUnit";
import { SensorChoice } from "./SensorChoice";
import { SeriesChoice } from "./SeriesChoice";
import type { LiveCheck } from "./useLiveCheck";

const HANDS: Record<string, string[]> = { right: ["right"], left: ["left"], both: ["right", "left"] };
const SERIES = ["depth_pattern", "color_pattern", "camera_shifts"] as const;

interface ImportOptionsFormProps {
  importId: string;
  report: ImportReport;
  live: LiveCheck;
}

/** What files don't say themselves, all of it at once; what is needed is marked, and the report follows while one types. */
export function ImportOptionsForm({ importId, report, live }: ImportOptionsFormProps) {
  const [isMoreShown, more] = useDisclosure(false);
  const formats = useImportFormats().data ?? [];
  const { draft, set } = live;
  const takes = report.takes ?? [];
  const questions = report.questions ?? [];
  const ask = (name: string): ImportQuestion | undefined => questions.find(({ field }) => field === name);
  const isNeeded = (name: string): boolean => ask(name)?.is_required ?? false;
  const text = (name: string): string => String(draft[name] ?? "");
  const fault = (name: string): string | undefined => (isNeeded(name) ? (text(name) === "" ? "Needed" : ask(name)?.ask) : undefined);
  const hands = Object.keys(HANDS).find((key) => HANDS[key]?.join() === String(draft["hands"] ?? "")) ?? "right";
  const sensors = report.sensors ?? [];
  const benchmark = ask("intrinsics")?.choices.map(({ label }) => label) ?? [];
  const gaps = ask("allow_gaps");
  const hasGaps = gaps !== undefined || draft["allow_gaps"] === true;
  const Chevron = isMoreShown ? IconChevronDown : IconChevronRight;

  return (
    <section className="card" style={{ padding: 16 }} aria-label="What the files do not say">
      <Stack gap="md">
        <Group gap="sm">
          <Title order={2}>What the files do not say</Title>
          {live.isBehind && !live.failure && (
            <Group gap={8} role="status">
              <Loader size={14} />
              <Text size="sm" className="quiet">
                Checking again …
              </Text>
            </Group>
          )}
        </Group>
        {SERIES.map((name) => {
          const question = ask(name);
          return question && question.choices.length > 0 ? (
            <SeriesChoice key={name} importId={importId} question={question} chosen={text(name) || null} onChoose={(value) => set({ [name]: value })} />
          ) : null;
        })}
        {sensors.length > 0 && (
          <SensorChoice
            sensors={sensors}
            chosen={text("preset") || null}
            isOpen={["fx", "cx", "cy", "depth_scale"].some(isNeeded)}
            onChoose={(sensor) => set(sensor ? withSensor(draft, sensor) : { preset: undefined })}
          />
        )}
        {benchmark.length > 0 && (
          <Select label="Camera of the benchmark" description={ask("intrinsics")?.ask} data={benchmark} value={text("intrinsics") || null} clearable w={416} onChange={(value) => set({ intrinsics: value ?? undefined })} />
        )}
        {numberFields(takes).length > 0 && (
          <SimpleGrid cols={{ base: 2, sm: 4 }} spacing="md">
            {numberFields(takes).map(({ name, label, unit, hint }) => (
              <NumberInput
                key={name}
                name={name}
                label={unit ? `${label}, ${unit}` : label}
                description={hint}
                value={draft[name] as string | number | undefined ?? ""}
                withAsterisk={isNeeded(name)}
                error={fault(name)}
                className={classes.number}
                hideControls
                decimalScale={9}
                onChange={(value) => set({ [name]: value })}
              />
            ))}
          </SimpleGrid>
        )}
        {takes.includes("object_unit_m") && <ObjectUnit question={ask("object_unit_m")} value={draft["object_unit_m"] as string | number | undefined} onChange={(value) => set({ object_unit_m: value })} />}
        <DepthPreview report={report} hint={isNeeded("depth_scale") && text("depth_scale") === "" ? (ask("depth_scale")?.ask ?? "") : ""} />
        {isNeeded("world_unit_m") && text("world_unit_m") === "" && (
          <Text size="sm" className="quiet">
            {ask("world_unit_m")?.ask}
          </Text>
        )}
        {takes.includes("hands") && (
          <Group gap="sm">
            <Text size="sm">Hands seen</Text>
            <SegmentedControl aria-label="Hands seen" value={hands} data={Object.keys(HANDS)} onChange={(key) => set({ hands: HANDS[key] ?? ["right"] })} />
            {ask("hands") && (
              <Text size="sm" className="quiet">
                {ask("hands")?.ask}
              </Text>
            )}
          </Group>
        )}
        {hasGaps && (
          <Checkbox
            label={gaps?.label ?? "Import although frames are missing"}
            description={gaps?.ask}
            error={gaps?.is_required ? "Tick it, or import again with the missing files" : undefined}
            checked={draft["allow_gaps"] === true}
            onChange={(event) => set({ allow_gaps: event.currentTarget.checked || undefined })}
          />
        )}
        <Button variant="subtle" size="compact-sm" display={SERIES.some((name) => takes.includes(name)) || takes.includes("hands") ? undefined : "none"} onClick={more.toggle} aria-expanded={isMoreShown} leftSection={<Chevron size={14} aria-hidden />} style={{ alignSelf: "flex-start" }}>
          {SERIES.some((name) => takes.includes(name)) ? "Patterns and format" : "Format"}
        </Button>
        <Collapse expanded={isMoreShown}>
          <SimpleGrid cols={{ base: 2, sm: 3 }} spacing="md">
            {SERIES.filter((name) => takes.includes(name)).map((name) => (
              <TextInput
                key={name}
                label={name === "depth_pattern" ? "Depth images lie at" : "Colour images lie at"}
                description={name === "depth_pattern" ? "Such as depth/depth_*.png" : "Such as color/*.png, or none"}
                value={text(name)}
                error={isNeeded(name) && text(name) !== "" ? ask(name)?.problem : undefined}
                onChange={(event) => set({ [name]: event.currentTarget.value })}
              />
            ))}
            <Select label="Format" description="Recognised when empty" data={formats.map((value) => ({ value, label: formatFileFormat(value).replace(/^./, (letter) => letter.toUpperCase()) }))} value={text("format") || null} clearable onChange={(format) => set({ format: format ?? undefined })} />
          </SimpleGrid>
        </Collapse>
        {live.failure && (
          <Group gap="sm" role="alert">
            <Text size="sm" c="var(--bad-text)" style={{ overflowWrap: "anywhere" }}>
              {live.failure.message} What you typed is kept.
            </Text>
            <Button size="xs" variant="default" onClick={live.retry}>
              Try again
            </Button>
          </Group>
        )}
      </Stack>
    </section>
  );
}
