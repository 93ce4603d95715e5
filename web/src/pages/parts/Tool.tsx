import { ActionIcon, Tooltip } from "@mantine/core";
import type { ReactNode } from "react";
import { useHint } from "../../state/keys";

interface ToolProps {
  label: string;
  action: string;
  icon: ReactNode;
  isOn?: boolean;
  isDisabled?: boolean;
  onClick: () => void;
}

/** A button of the tool rail; its hint says the key of its action. */
export function Tool({ label, action, icon, isOn, isDisabled = false, onClick }: ToolProps) {
  const hint = useHint();
  return (
    <Tooltip label={hint(label, action)} position="right">
      <ActionIcon
        size={32}
        variant={isOn ? "light" : "subtle"}
        color={isOn ? "teal" : "gray"}
        aria-label={label}
        aria-pressed={isOn}
        aria-disabled={isDisabled}
        data-disabled={isDisabled || undefined}
        onClick={isDisabled ? undefined : onClick}
      >
        {icon}
      </ActionIcon>
    </Tooltip>
  );
}
