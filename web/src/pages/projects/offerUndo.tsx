import { Button, Group } from "@mantine/core";
import { notifications } from "@mantine/notifications";

export const tellFailure = (failure: Error): void => {
  notifications.show({ color: "red", title: "That was not done", message: failure.message });
};

/** Say what was done, and let it be undone. It outlives the row that it was done from. */
export function offerUndo(message: string, undo: () => Promise<unknown>): void {
  const id = notifications.show({
    autoClose: 12_000,
    message: (
      <Group gap="sm" justify="space-between">
        {message}
        <Button
          size="compact-xs"
          variant="default"
          onClick={() => {
            notifications.hide(id);
            undo().catch(tellFailure);
          }}
        >
          Undo
        </Button>
      </Group>
    ),
  });
}
