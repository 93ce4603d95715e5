import { Group, Kbd, Text } from "@mantine/core";
import { IconArrowBackUp, IconCheck, IconEyeOff, IconHelp, IconX } from "@tabler/icons-react";
import { Link } from "react-router";
import type { Reason, Registration } from "../../api/registrations";
import { formatCount, formatNumber } from "../../model/format";
import type { Standing } from "../../state/decisionLog";
import { useKeyOf } from "../../state/keys";
import { HandBadge } from "../parts/HandBadge";
import classes from "./CuratePage.module.css";
import { DecisionBadge, VerdictBadge } from "./Verdict";

interface DecisionPanelProps {
  item: Registration;
  mine: Standing | null;
  reasons: readonly Reason[];
  mayDecide: boolean;
  /** Nothing is judged before it is on the screen. */
  isDrawn: boolean;
  onDecide: (decision: Standing, reasons?: readonly string[]) => void;
  canUndo: boolean;
  onUndo: () => void;
}

const ACTS = [
  { kind: "accept", label: "Accept", icon: IconCheck },
  { kind: "reject", label: "Reject", icon: IconX },
  { kind: "unsure", label: "Unsure", icon: IconHelp },
] as const;

const mm = (value: number | null): string => (value === null ? "–" : `${formatNumber(value, 2)} mm`);

/** What is judged, what the program thinks of it, and what one can say. */
export function DecisionPanel({ item, mine, reasons, mayDecide, isDrawn, onDecide, canUndo, onUndo }: DecisionPanelProps) {
  const keyOf = useKeyOf();
  const { scan } = item;
  return (
    <aside className={classes.panel} aria-label="The registration and the decision" tabIndex={0}>
      <div>
        <Link to={`/scans/${scan.id}`} className={classes.name} title={scan.name}>
          {scan.name}
        </Link>
        <Group gap={8} mt={4}>
          <HandBadge hand={item.side} />
          <Text size="xs" className="quiet one-line">
            {[scan.subject, scan.pose].filter(Boolean).join(" · ")}
          </Text>
        </Group>
        <Group gap={8} mt={8}>
          <Text size="xs" className="quiet">
            The program says
          </Text>
          <VerdictBadge verdict={item.verdict} />
          {(mine || (item.decision && !item.is_hidden)) && (
            <Text size="xs" className="quiet" ml={8}>
              {mine ? "you" : formatCount(item.reviewer_count, "person", "people")}
            </Text>
          )}
          {mine ? <DecisionBadge decision={mine} /> : item.decision && !item.is_hidden && <DecisionBadge decision={item.decision} />}
        </Group>
        {!mine && item.is_hidden && (
          <Group gap={8} mt={8} wrap="nowrap">
            <IconEyeOff size={16} aria-hidden style={{ flex: "none" }} />
            <Text size="xs">Second review: somebody has decided; what they said is hidden from you.</Text>
          </Group>
        )}
        {item.reasons.length > 0 && (
          <ul className={classes.doubts}>
            {item.reasons.map((reason) => (
              <li key={reason}>{reason}</li>
            ))}
          </ul>
        )}
      </div>
      {!mayDecide && (
        <Text size="xs" className="quiet">
          Reviewers and leads decide; you can only look.
        </Text>
      )}
      <div className={classes.acts} role="group" aria-label="Decision">
        {ACTS.map(({ kind, label, icon: Icon }) => (
          <button key={kind} type="button" className={classes.act} data-kind={kind} aria-pressed={mine === kind} disabled={!mayDecide || !isDrawn} onClick={() => onDecide(kind)}>
            <Icon size={18} aria-hidden />
            {label}
            <Kbd size="xs" aria-hidden>
              {keyOf(`curate.${kind}`) || "–"}
            </Kbd>
          </button>
        ))}
        <button type="button" className={classes.act} data-kind="undo" disabled={!canUndo} title="Undo the last decision" onClick={onUndo}>
          <IconArrowBackUp size={18} aria-hidden />
          Undo
          <Kbd size="xs" aria-hidden>
            {keyOf("curate.undo") || "–"}
          </Kbd>
        </button>
      </div>
      <section aria-label="Reject for a reason">
        <Text size="xs" className="quiet" mb={4}>
          Reject for a reason
        </Text>
        <ol className={classes.reasons}>
          {reasons.map((reason, at) => (
            <li key={reason.name}>
              <button type="button" className={classes.reason} disabled={!mayDecide || !isDrawn} onClick={() => onDecide("reject", [reason.name])}>
                <Kbd size="xs" aria-hidden>
                  {keyOf(`curate.reason${at + 1}`) || "–"}
                </Kbd>
                {reason.label}
              </button>
            </li>
          ))}
        </ol>
      </section>
      <section aria-label="Figures">
        <dl className={classes.facts}>
          <dt>Scan to mesh, mean</dt>
          <dd>{mm(item.scan_to_mesh_mm.mean)}</dd>
          <dt>median</dt>
          <dd>{mm(item.scan_to_mesh_mm.median)}</dd>
          <dt>95 % below</dt>
          <dd>{mm(item.scan_to_mesh_mm.p95)}</dd>
          <dt>Score, less is better</dt>
          <dd>{formatNumber(item.score, 3)}</dd>
          <dt>Model</dt>
          <dd title={item.model_name}>
            <Link to={`/models/${item.model_id}`} style={{ color: "inherit" }}>
              {item.model_name}
            </Link>
          </dd>
          <dt>Round</dt>
          <dd>{item.round}</dd>
          <dt>Collection</dt>
          <dd title={scan.collection}>{scan.collection}</dd>
        </dl>
      </section>
    </aside>
  );
}
