import { Button, Group, Text } from "@mantine/core";
import { decisionLog } from "../../state/deciding";
import type { DecisionStatus } from "../../state/decisionLog";
import classes from "./CuratePage.module.css";

/** What the server does not take, why, and what one can do about it. */
export function DecisionRefusals({ status, onGo }: { status: DecisionStatus; onGo: (registrationId: string) => void }) {
  if (status.refusals.size === 0) return null;
  return (
    <div className={classes.refusals}>
      {[...status.refusals].map(([operationId, { decision, reason }]) => (
        <section key={operationId} className={`card ${classes.refusal}`} role="alert">
          <Text size="sm" fw={600} style={{ overflowWrap: "anywhere" }}>
            {`“${decision.decision}” of ${decision.name || "a registration"} was not taken`}
          </Text>
          <Text size="xs" my={8} style={{ overflowWrap: "anywhere" }}>
            {reason} It is kept in this browser until you drop it.
          </Text>
          <Group gap="sm">
            <Button size="compact-xs" variant="default" onClick={() => decisionLog().discard(operationId)}>
              Drop it
            </Button>
            <Button size="compact-xs" variant="subtle" onClick={() => onGo(decision.registrationId)}>
              Show
            </Button>
          </Group>
        </section>
      ))}
    </div>
  );
}
