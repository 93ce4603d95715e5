import { Group, Text, Title } from "@mantine/core";
import type { FrameRegistration, MovingRegistration, MovingScan } from "../../api/movingScans";
import { formatNumber } from "../../model/format";
import { DecisionBadge, VerdictBadge } from "../curate/Verdict";
import classes from "./Moving.module.css";
import { PRIORS } from "./priors";

const mm = (value: number | null): string => (value === null ? "–" : `${formatNumber(value, 2)} mm`);

interface FramePanelProps {
  scan: MovingScan;
  frame: number;
  found: FrameRegistration | undefined;
  registration: MovingRegistration | undefined;
}

/** What is known of the frame that is shown, and of the registration that it is of. */
export function FramePanel({ scan, frame, found, registration }: FramePanelProps) {
  const problem = scan.problems.find((one) => one.frame === frame);
  return (
    <section aria-label="The frame">
      <Title order={2}>Frame {frame}</Title>
      {problem && (
        <Text size="xs" c="var(--bad-text)" style={{ overflowWrap: "anywhere" }}>
          {problem.name} cannot be used: {problem.detail}
        </Text>
      )}
      {!problem && !found && (
        <Text size="xs" className="quiet">
          {registration ? "Not registered here." : "Not registered yet."}
        </Text>
      )}
      {found && (
        <Group gap={8}>
          <Text size="xs" className="quiet">
            The program says
          </Text>
          <VerdictBadge verdict={found.verdict} />
          {found.decision && <DecisionBadge decision={found.decision} />}
        </Group>
      )}
      {found && found.reasons.length > 0 && (
        <ul className={classes.doubts}>
          {found.reasons.map((reason) => (
            <li key={reason}>{reason}</li>
          ))}
        </ul>
      )}
      <dl className={classes.facts} style={{ marginTop: 8 }}>
        {found && (
          <>
            <dt>Scan to body, mean</dt>
            <dd>{mm(found.mean_mm)}</dd>
            <dt>95 % below</dt>
            <dd>{mm(found.p95_mm)}</dd>
          </>
        )}
        {registration && (
          <>
            <dt>Registration {registration.number}</dt>
            <dd>{PRIORS[registration.prior].label}</dd>
            <dt>Mean of its frames</dt>
            <dd>{mm(registration.scan_to_mesh_mm)}</dd>
            <dt>Good, doubtful, bad</dt>
            <dd>{(["good", "doubtful", "bad"] as const).map((name) => registration.verdicts[name] ?? 0).join(", ")}</dd>
            <dt>Guessed left, right</dt>
            <dd>{(["left", "right"] as const).map((hand) => registration.guessed[hand] ?? 0).join(", ")}</dd>
            <dt>Made</dt>
            <dd>{[registration.created_by_name, new Date(registration.created_at).toLocaleString()].filter(Boolean).join(", ")}</dd>
          </>
        )}
      </dl>
    </section>
  );
}
