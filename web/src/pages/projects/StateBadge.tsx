import { Badge } from "@mantine/core";
import { IconArrowBackUp, IconCheck, IconPencil, IconSend } from "@tabler/icons-react";
import type { AssignmentState } from "../../api/teams";

const STATES: Record<AssignmentState, { color: string; icon: typeof IconCheck; label: string }> = {
  open: { color: "gray", icon: IconPencil, label: "open" },
  submitted: { color: "blue", icon: IconSend, label: "in review" },
  returned: { color: "yellow", icon: IconArrowBackUp, label: "returned" },
  accepted: { color: "teal", icon: IconCheck, label: "accepted" },
};

/** Where a piece of work is; the sign says it without the colour. */
export function StateBadge({ state }: { state: AssignmentState }) {
  const { color, icon: Icon, label } = STATES[state];
  return (
    <Badge variant="light" color={color} leftSection={<Icon size={12} aria-hidden />} tt="none" miw={96} style={{ flex: "none" }} styles={{ root: { justifyContent: "center", gridTemplateColumns: "auto auto" }, label: { flex: "none" }, section: { marginInlineEnd: 6 } }} data-testid="assignment-state">
      {label}
    </Badge>
  );
}
