import { Badge } from "@mantine/core";
import { IconAlertTriangle, IconCheck, IconHelp, IconX } from "@tabler/icons-react";
import type { Verdict } from "../../api/registrations";
import type { Standing } from "../../state/decisionLog";

const VERDICTS: Record<Verdict, { color: string; icon: typeof IconCheck }> = {
  good: { color: "teal", icon: IconCheck },
  doubtful: { color: "yellow", icon: IconHelp },
  bad: { color: "red", icon: IconAlertTriangle },
};

/** What the program thinks of its own registration. */
export function VerdictBadge({ verdict }: { verdict: Verdict }) {
  const { color, icon: Icon } = VERDICTS[verdict];
  return (
    <Badge variant="light" color={color} c={color === "yellow" ? "var(--warn-text)" : undefined} leftSection={<Icon size={12} aria-hidden />} tt="none">
      {verdict}
    </Badge>
  );
}

const DECISIONS: Record<Standing, { color: string; icon: typeof IconCheck; label: string }> = {
  accept: { color: "teal", icon: IconCheck, label: "accepted" },
  reject: { color: "red", icon: IconX, label: "rejected" },
  unsure: { color: "yellow", icon: IconHelp, label: "unsure" },
};

/** What a person decided. */
export function DecisionBadge({ decision }: { decision: Standing }) {
  const { color, icon: Icon, label } = DECISIONS[decision];
  return (
    <Badge variant="filled" color={color} c={color === "yellow" ? "dark.9" : undefined} leftSection={<Icon size={12} aria-hidden />} tt="none">
      {label}
    </Badge>
  );
}
