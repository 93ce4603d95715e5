import { Checkbox, Group, NumberInput, SegmentedControl, Select, Tooltip } from "@mantine/core";
import type { Comparison, EvaluationChoice } from "../../api/evaluations";
import { SourceFilter } from "../parts/SourceFilter";
import { LabelsPicker } from "./LabelsPicker";
import classes from "./Evaluations.module.css";

interface FiltersProps {
  choice: EvaluationChoice;
  comparison: Comparison | undefined;
  onChange: (part: Partial<EvaluationChoice>) => void;
}

/** Which joints count, for all tables and curves of the page and for its reports. */
export function Filters({ choice, comparison, onChange }: FiltersProps) {
  const cameras = comparison?.cameras ?? [];
  return (
    <Group gap="md" className={classes.filters} role="group" aria-label="Which joints count">
      <SegmentedControl
        size="xs"
        aria-label="Joints"
        data={[
          { value: "", label: "All joints" },
          { value: "visible", label: "Visible" },
          { value: "occluded", label: "Occluded" },
        ]}
        value={choice.visibility}
        onChange={(visibility) => onChange({ visibility })}
      />
      <SegmentedControl
        size="xs"
        aria-label="Hand"
        data={[
          { value: "", label: "Both hands" },
          { value: "right", label: "Right" },
          { value: "left", label: "Left" },
        ]}
        value={choice.hand}
        onChange={(hand) => onChange({ hand })}
      />
      <SourceFilter chosen={choice.sources} onChange={(sources) => onChange({ sources })} />
      {cameras.length > 1 && (
        <Select
          size="xs"
          w={144}
          aria-label="Camera"
          allowDeselect={false}
          data={[{ value: "", label: "All cameras" }, ...cameras.map((id) => ({ value: id, label: id }))]}
          value={choice.camera}
          onChange={(camera) => onChange({ camera: camera ?? "" })}
        />
      )}
      <Tooltip label="The tracker may have started from its annotation" multiline maw={280}>
        <Checkbox size="xs" label="Without the first frame" checked={choice.withoutStart} onChange={(event) => onChange({ withoutStart: event.currentTarget.checked })} />
      </Tooltip>
      <Group gap={8} ml="auto">
        {comparison && <LabelsPicker comparison={comparison} snapshots={choice.snapshots} onChange={(snapshots) => onChange({ snapshots })} />}
        <NumberInput
          size="xs"
          w={128}
          aria-label="Within, px"
          prefix="within "
          suffix=" px"
          min={0.1}
          max={1000}
          step={1}
          decimalScale={1}
          value={choice.within}
          onChange={(within) => typeof within === "number" && within > 0 && within <= 1000 && onChange({ within })}
        />
      </Group>
    </Group>
  );
}
