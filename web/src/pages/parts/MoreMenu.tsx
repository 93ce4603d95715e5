import { ActionIcon, Menu, Tooltip } from "@mantine/core";
import { IconDots, IconTrash } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { For } from "./For";

interface MoreMenuProps {
  /** Beside large buttons. */
  isLarge?: boolean;
  onDelete: () => void;
  children: ReactNode;
}

/** What else can be done with the thing that a page shows; leads may delete it. */
export function MoreMenu({ isLarge = false, onDelete, children }: MoreMenuProps) {
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        <Tooltip label="More">
          <ActionIcon {...(isLarge ? { size: 36, variant: "default" } : {})} aria-label="More">
            <IconDots size={18} />
          </ActionIcon>
        </Tooltip>
      </Menu.Target>
      <Menu.Dropdown>
        {children}
        <For role="lead">
          <Menu.Item color="red" onClick={onDelete} leftSection={<IconTrash size={16} aria-hidden />}>
            Delete (can be undone)
          </Menu.Item>
        </For>
      </Menu.Dropdown>
    </Menu>
  );
}
