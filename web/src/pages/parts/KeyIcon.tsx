import { ActionIcon, Tooltip, type ActionIconProps } from "@mantine/core";
import type { ReactNode } from "react";
import { useHint } from "../../state/keys";

interface KeyIconProps extends ActionIconProps {
  label: string;
  /** Its name in the key map. */
  action: string;
  /** The hint, where it says more than the label. */
  told?: string;
  onClick: () => void;
  children: ReactNode;
}

/** A button with a picture; its hint says the key of its action. */
export function KeyIcon({ label, action, told = label, children, ...button }: KeyIconProps) {
  const hint = useHint();
  return (
    <Tooltip label={hint(told, action)}>
      <ActionIcon aria-label={label} {...button}>
        {children}
      </ActionIcon>
    </Tooltip>
  );
}
