import { ActionIcon, Popover, Tooltip } from "@mantine/core";
import { useState, type ReactNode } from "react";

interface ToolPopoverProps {
  label: string;
  icon: ReactNode;
  isOn?: boolean;
  isDisabled?: boolean;
  width?: number;
  /** What is inside; it is made only while it is open, and closes itself. */
  children: (close: () => void) => ReactNode;
}

/** A button of the tool rail that opens settings beside it. */
export function ToolPopover({ label, icon, isOn = false, isDisabled = false, width = 264, children }: ToolPopoverProps) {
  const [isOpen, setOpen] = useState(false);
  return (
    <Popover opened={isOpen} onChange={setOpen} position="right-start" withArrow shadow="md" trapFocus returnFocus width={width}>
      <Popover.Target>
        <Tooltip label={label} position="right" disabled={isOpen}>
          <ActionIcon
            size={32}
            aria-label={label}
            aria-disabled={isDisabled}
            data-disabled={isDisabled || undefined}
            variant={isOn ? "light" : "subtle"}
            color={isOn ? "teal" : "gray"}
            onClick={() => !isDisabled && setOpen(!isOpen)}
          >
            {icon}
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown aria-label={label}>{isOpen && children(() => setOpen(false))}</Popover.Dropdown>
    </Popover>
  );
}
