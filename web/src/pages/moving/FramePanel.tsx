import { Group, Text, Title } from "@mantine/core";
import type { FrameRegistration, MovingRegistration, MovingScan } from "../../api/movingScans";
import { formatNumber } from "../../model/format";
import { DecisionBadge, VerdictBadge } from "../curate/Verdict";
import classes from "./Moving.module.css";

const mm = (value: number | null): string => (value === null ? "–" : `${formatNumber(value, 2)} mm`);

interface FramePanelProps {
  scan: MovingScan;
  frame: number;
  found: FrameRegistration | undefined;
  /** The registration that it was found in. */
  foundIn: MovingRegistration | undefined;
  /** The chosen one. */
  registration: MovingRegistration | undefined;
}

/** What is known of the frame that is shown. */
export function FramePanel({ scan, frame, found, foundIn, registration }: FramePanelProps) {
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
          {registration ? `Registration ${registration.number} does not have it${registration.frames_done > 0 ? "" : " yet"}.` : "Not registered yet."}
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
      {found && (
        <dl className={classes.facts} style={{ marginTop: 8 }}>
          <div className={classes.row}>
            <dt>Scan to body, mean</dt>
            <dd>{mm(found.mean_mm)}</dd>
          </div>
          <div className={classes.row}>
            <dt>95 % below</dt>
            <dd>{mm(found.p95_mm)}</dd>
          </div>
          {foundIn && foundIn.id !== registration?.id && (
            <div className={classes.row}>
              <dt>Of</dt>
              <dd>registration {foundIn.number}, which {registration?.number} continues</dd>
            </div>
          )}
        </dl>
      )}
    </section>
  );
}
