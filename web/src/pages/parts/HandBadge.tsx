import { Group, Text } from "@mantine/core";
import type { Side } from "../../api/types";
import { HAND_COLORS } from "../../model/joints";

/** Right is an orange disc, left a blue square: the shape says it without the colour. */
export function HandMark({ hand, size = 10 }: { hand: Side; size?: number }) {
  return (
    <svg width={size} height={size} viewBox="0 0 10 10" aria-hidden style={{ flex: "none" }}>
      {hand === "right" ? <circle cx="5" cy="5" r="4.5" fill={HAND_COLORS.right} /> : <rect x="0.75" y="0.75" width="8.5" height="8.5" fill={HAND_COLORS.left} />}
    </svg>
  );
}

export function HandBadge({ hand }: { hand: string }) {
  if (hand !== "right" && hand !== "left") return <Text size="xs">{hand}</Text>;
  return (
    <Group gap={6} wrap="nowrap" component="span">
      <HandMark hand={hand} />
      <Text size="xs" span c={`var(--hand-${hand}-text)`}>
        {hand}
      </Text>
    </Group>
  );
}
