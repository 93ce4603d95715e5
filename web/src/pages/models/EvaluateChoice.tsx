import { Radio, Stack } from "@mantine/core";
import type { Evaluate } from "../../api/handModels";

interface EvaluateChoiceProps {
  value: Evaluate;
  onChange: (value: Evaluate) => void;
  /** Without people kept for testing there is nobody to judge on. */
  hasPeople: boolean;
}

/** Whether, and how thoroughly, a model is judged on the subjects that are left out. */
export function EvaluateChoice({ value, onChange, hasPeople }: EvaluateChoiceProps) {
  return (
    <Radio.Group
      label="Evaluate on the subjects left out"
      description={hasPeople ? "Once the model is stored and can be used" : "Leave subjects out, and the model can be judged on them"}
      value={hasPeople ? value : "no"}
      onChange={(chosen) => onChange(chosen)}
    >
      <Stack gap="sm" mt="sm">
        <Radio value="no" label="No" disabled={!hasPeople} />
        <Radio value="quick" label="Quick: beside the untrained hand, and with the blend shapes off; under a minute" disabled={!hasPeople} />
        <Radio value="full" label="Full: also trains plain skinning, and right hands only, to compare with; three times as long as training" disabled={!hasPeople} />
      </Stack>
    </Radio.Group>
  );
}
