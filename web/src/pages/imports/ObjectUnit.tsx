import { Group, NumberInput, Radio, Stack, Text } from "@mantine/core";
import type { ImportQuestion } from "../../api/types";

interface ObjectUnitProps {
  question: ImportQuestion | undefined;
  /** Metres per unit, as typed. */
  value: string | number | undefined;
  onChange: (metres: string | number | undefined) => void;
}

/** The unit of the meshes of objects: the usual ones with the size that each makes, or another. */
export function ObjectUnit({ question, value, onChange }: ObjectUnitProps) {
  const choices = question?.choices ?? [];
  const isChosen = value !== undefined && value !== "";
  const taken = isChosen ? Number(value) : question?.proposal;
  return (
    <Group gap="xl" align="flex-start" role="group" aria-label="Unit of the objects’ meshes">
      <Radio.Group
        label="Unit of the objects’ meshes"
        description={question?.ask}
        error={question?.is_required ? "Needed" : undefined}
        value={typeof taken === "number" ? String(taken) : ""}
        onChange={(next) => onChange(Number(next))}
      >
        <Stack gap="xs" mt="sm">
          {choices.map((choice) => (
            <Radio key={choice.label} value={String(choice.value)} label={!isChosen && choice.value === question?.proposal ? `${choice.label} (guessed)` : choice.label} />
          ))}
          {choices.length === 0 && (
            <Text size="sm" className="quiet">
              No usual unit gives it a size that a hand can hold.
            </Text>
          )}
        </Stack>
      </Radio.Group>
      <NumberInput w={176} label="Another: 1 unit is, in m" value={isChosen && !choices.some((choice) => choice.value === Number(value)) ? value : ""} hideControls decimalScale={9} onChange={(next) => onChange(next === "" ? undefined : next)} />
    </Group>
  );
}
