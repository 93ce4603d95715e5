import { Button, Group, Text } from "@mantine/core";
import { ALL_SOURCES, describeLeftOut, type JointsOfSource } from "../../model/source";

interface LeftOutProps {
  /** Before the sentence, where there are several: "Track 2". */
  name?: string;
  sources: readonly JointsOfSource[];
  onSources: (chosen: readonly string[]) => void;
}

/** Says how many joints do not count and why, and offers to count them. Nothing where all do. */
export function LeftOut({ name, sources, onSources }: LeftOutProps) {
  const told = describeLeftOut(sources);
  if (!told) return null;
  return (
    <Group gap={8} mt="sm" role="note" aria-label="Joints left out">
      <Text size="sm">
        {name && `${name}: `}
        {told}
      </Text>
      <Button size="compact-xs" variant="default" onClick={() => onSources([ALL_SOURCES])}>
        Count them too
      </Button>
    </Group>
  );
}
