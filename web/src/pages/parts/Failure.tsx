import { Button, Group, Stack, Text, Title } from "@mantine/core";
import { IconAlertTriangle, IconLock, IconPlugConnectedX } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { Link } from "react-router";
import { ApiError } from "../../api/client";

interface FailureProps {
  /** What was being done: "The recordings could not be loaded". */
  what: string;
  error: unknown;
  /** What is safe all the same. */
  safe?: string;
  onRetry?: () => void;
  children?: ReactNode;
}

/** What happened, what is safe, and the next step. */
export function Failure({ what, error, safe, onRetry, children }: FailureProps) {
  const isOffline = error instanceof ApiError && error.isOffline;
  const isForbidden = error instanceof ApiError && error.status === 403;
  const Icon = isOffline ? IconPlugConnectedX : isForbidden ? IconLock : IconAlertTriangle;
  return (
    <Stack align="center" gap="sm" py={48} px="md" ta="center" role="alert">
      <Icon size={40} stroke={1.5} color={isForbidden ? "var(--text-quiet)" : "var(--bad-text)"} aria-hidden />
      <Title order={2}>{isForbidden ? "You cannot open this now" : what}</Title>
      <Text maw={560} className="quiet" style={{ overflowWrap: "anywhere" }}>
        {error instanceof Error ? error.message : String(error)}
      </Text>
      {safe && !isForbidden && (
        <Text maw={560} size="sm" className="quiet">
          {safe}
        </Text>
      )}
      <Group mt="sm" justify="center">
        {onRetry && !isForbidden && (
          <Button variant="default" onClick={onRetry}>
            Try again
          </Button>
        )}
        {children}
        {isForbidden && !children && (
          <Button variant="default" component={Link} to="/recordings">
            To the recordings
          </Button>
        )}
      </Group>
    </Stack>
  );
}
