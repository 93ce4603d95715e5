import { Button, Group, Loader, Progress, Stack, Text } from "@mantine/core";
import type { ReactNode } from "react";

interface SendingProps {
  /** 0..1; 1 means that the server is reading. */
  sent: number;
  title: ReactNode;
  /** More about it, below the title. */
  children?: ReactNode;
  onCancel: () => void;
}

/** How far what was chosen is on its way to the server. */
export function Sending({ sent, title, children, onCancel }: SendingProps) {
  const isReading = sent >= 1;
  return (
    <Stack gap="md">
      <Group gap="sm" role="status">
        {isReading && <Loader size="sm" />}
        {title}
      </Group>
      {children}
      <Progress value={100 * sent} animated={isReading} aria-label="Part that was sent" />
      <Group justify="space-between">
        <Text size="sm">{isReading ? "" : `${Math.round(100 * sent)} %`}</Text>
        <Button variant="default" onClick={onCancel}>
          Cancel
        </Button>
      </Group>
    </Stack>
  );
}
