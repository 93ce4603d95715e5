import { ScrollArea, Stack, Text } from "@mantine/core";

interface FaultListProps {
  label: string;
  faults: readonly { name: string; detail: string }[];
}

/** What cannot be used, each with the reason. */
export function FaultList({ label, faults }: FaultListProps) {
  return (
    <ScrollArea.Autosize mah={240} tabIndex={0} aria-label={label}>
      <Stack gap="sm" role="alert">
        {faults.map(({ name, detail }) => (
          <div key={name} style={{ overflowWrap: "anywhere" }}>
            <Text size="sm" fw={600}>
              {name}
            </Text>
            <Text size="xs" c="var(--bad-text)">
              {detail}
            </Text>
          </div>
        ))}
      </Stack>
    </ScrollArea.Autosize>
  );
}
