import { Button, Group, Skeleton, Text } from "@mantine/core";

interface AwaitedProps {
  /** "The assignments". */
  what: string;
  query: { error: Error | null; refetch: () => unknown };
  height?: number;
}

/** A part of a page that is not there yet: a skeleton, or why it did not come, and the way to ask again. */
export function Awaited({ what, query, height = 120 }: AwaitedProps) {
  if (!query.error) return <Skeleton height={height} radius="lg" />;
  return (
    <Group className="card" p="md" gap="sm" role="alert">
      <Text size="sm" c="var(--bad-text)" style={{ overflowWrap: "anywhere" }}>
        {what} could not be loaded: {query.error.message}
      </Text>
      <Button size="xs" variant="default" onClick={() => void query.refetch()}>
        Try again
      </Button>
    </Group>
  );
}
