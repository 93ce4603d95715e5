import { Group, Stack, Text } from "@mantine/core";
import { IconAlertTriangle, IconInfoCircle } from "@tabler/icons-react";
import type { ReactNode } from "react";
import type { JobCheck } from "../../api/jobChecks";
import classes from "./Obstacles.module.css";

export interface ObstaclesProps {
  check?: JobCheck | undefined;
  /** What the request answered, when it was refused all the same. */
  failure?: Error | null | undefined;
  /** What that means, behind the failure's own words. */
  failed?: string | undefined;
  /** What helps: a link or a button, shown while something is in the way. */
  help?: ReactNode;
}

/** Why a job cannot be started, beside the button that would start it; and what one should know when it can be. */
export function Obstacles({ check, failure, failed = "No job was started.", help }: ObstaclesProps) {
  const obstacles = check?.obstacles ?? [];
  const isRefused = failure && !obstacles.some((obstacle) => failure.message.includes(obstacle));
  return (
    <>
      <Stack gap="sm" role="status" aria-label="Can this be started" className={classes.told}>
        {obstacles.map((obstacle) => (
          <Text key={obstacle} size="sm" c="var(--bad-text)" className={classes.line}>
            <IconAlertTriangle size={18} aria-label="In the way" />
            <span style={{ overflowWrap: "anywhere" }}>{obstacle}</span>
          </Text>
        ))}
        {obstacles.length > 0 && help}
        {check?.notes.map((note) => (
          <Text key={note} size="sm" className={classes.line}>
            <IconInfoCircle size={18} aria-label="Worth knowing" />
            <span>{note}</span>
          </Text>
        ))}
      </Stack>
      {isRefused && (
        <Text size="sm" c="var(--bad-text)" role="alert" style={{ overflowWrap: "anywhere" }}>
          {failure.message} {failed}
        </Text>
      )}
    </>
  );
}

/** The lower end of a form: what is in the way and the buttons, in sight however far the form is scrolled. */
export function FormFooter({ children, ...obstacles }: ObstaclesProps & { children: ReactNode }) {
  return (
    <Stack gap="sm" className={classes.footer}>
      <Obstacles {...obstacles} />
      <Group justify="flex-end" gap="sm">
        {children}
      </Group>
    </Stack>
  );
}
