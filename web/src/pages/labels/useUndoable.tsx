import { Button, Group } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useRestoreSnapshot, type Snapshot } from "../../api/labels";

/** Says what was done to a recording's labels and offers the way back: the snapshot that was kept before it. */
export function useUndoable(recording: string): (what: string, before: Snapshot) => void {
  const { mutateAsync } = useRestoreSnapshot(recording);
  return (what, before) => {
    const id = `undo-${before.id}`;
    const undo = (): void => {
      notifications.hide(id);
      // Said whether or not the part of the page that offered it is still there.
      mutateAsync(before.id).then(
        () => notifications.show({ message: "Undone: the labels are as they were before.", color: "teal" }),
        (failure: Error) => notifications.show({ color: "red", title: "Not undone", message: failure.message }),
      );
    };
    notifications.show({
      id,
      autoClose: 20000,
      color: "teal",
      message: (
        <Group justify="space-between" wrap="nowrap">
          <span>{what}</span>
          <Button size="compact-sm" variant="default" onClick={undo}>
            Undo
          </Button>
        </Group>
      ),
    });
  };
}
