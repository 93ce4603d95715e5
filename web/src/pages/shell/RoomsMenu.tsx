import { ActionIcon, Button, Drawer, Group, Indicator } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconKeyboard, IconMenu2 } from "@tabler/icons-react";
import { ThemeSwitch } from "./ThemeSwitch";
import { Rooms } from "./Rooms";

interface RoomsMenuProps {
  room: string;
  running: number;
  onKeys: () => void;
}

/** On a narrow screen: all rooms, and what else the header has no room for, behind one button. */
export function RoomsMenu({ room, running, onKeys }: RoomsMenuProps) {
  const [isOpen, { open, close }] = useDisclosure(false);
  return (
    <>
      <Indicator disabled={running === 0} size={8} offset={8}>
        <ActionIcon size={40} aria-label={running > 0 ? `Menu, ${running} jobs running` : "Menu"} aria-expanded={isOpen} onClick={open}>
          <IconMenu2 size={20} />
        </ActionIcon>
      </Indicator>
      <Drawer opened={isOpen} onClose={close} title="Handloom" size={288} closeButtonProps={{ "aria-label": "Close the menu" }} transitionProps={{ duration: 120 }}>
        <Rooms room={room} running={running} isList onChosen={close} />
        <Group justify="space-between" mt="md">
          <Button
            variant="default"
            leftSection={<IconKeyboard size={16} aria-hidden />}
            onClick={() => {
              close();
              onKeys();
            }}
          >
            Keyboard map
          </Button>
          <ThemeSwitch />
        </Group>
      </Drawer>
    </>
  );
}
