import { Group, Text } from "@mantine/core";
import { errorGradient } from "../../model/errorColor";
import type { FrameError } from "../../model/frameError";
import { LOST_COLOR } from "../../model/trackRows";

/** What the colours of the timeline mean. */
export function ErrorLegend({ error, hasLost }: { error: FrameError; hasLost: boolean }) {
  return (
    <Group gap="sm" mb={4} className="quiet">
      <Text size="xs">{error.label}, 0</Text>
      <span style={{ width: 96, height: 8, borderRadius: 2, background: errorGradient }} aria-hidden />
      <Text size="xs">{error.full} {error.unit} and more</Text>
      {hasLost && (
        <>
          <span style={{ width: 12, height: 8, borderRadius: 2, background: LOST_COLOR }} aria-hidden />
          <Text size="xs">lost, in the second row</Text>
        </>
      )}
    </Group>
  );
}
