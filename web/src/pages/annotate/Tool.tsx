import { ActionIcon, Tooltip } from "@mantine/core";
import type { ReactNode } from "react";
import { keyOf } from "../../model/keymap";

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
  const key = keyOf(action);
  return (
    <Tooltip label={key ? `${label} (${key})` : label} position="right">
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
