import { Checkbox } from "@mantine/core";

/** So many shape directions of parts of the hand follow those of the whole hand. */
export const LOCAL_SHAPES = 40;

/** Whether fingers, thumb and palm may vary by themselves, as they do from person to person. */
export function LocalShapesChoice({ value, onChange }: { value: boolean; onChange: (value: boolean) => void }) {
  return (
    <Checkbox
      label="Parts of the hand vary by themselves, too"
      description={`${LOCAL_SHAPES} more shape directions: the model comes closer to people unlike those whom it was learnt from`}
      checked={value}
      onChange={(event) => onChange(event.currentTarget.checked)}
    />
  );
}
