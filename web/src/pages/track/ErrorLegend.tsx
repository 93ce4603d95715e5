import { Group, Text } from "@mantine/core";
import { errorGradient, ERROR_FULL_MM } from "../../model/errorColor";
import { LOST_COLOR } from "../../model/trackRows";

/** What the colours of the timeline mean. */
export function ErrorLegend({ hasLost }: { hasLost: boolean }) {
  return (
    <Group gap="sm" mb={4} className="quiet">
      <Text size="xs">Depth residual, 0</Text>
      <span style={{ width: 96, height: 8, borderRadius: 2, background: errorGradient }} aria-hidden />
      <Text size="xs">{ERROR_FULL_MM} mm and more</Text>
      {hasLost && (
        <>
          <span style={{ width: 12, height: 8, borderRadius: 2, background: LOST_COLOR }} aria-hidden />
          <Text size="xs">lost, in the second row</Text>
        </>
      )}
    </Group>
  );
}
