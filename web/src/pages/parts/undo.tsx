/** The one way in which what was done can be taken back: a note that says it, with the way back, for a while. */

import { Button, Group } from "@mantine/core";
import { notifications } from "@mantine/notifications";

export const tellFailure = (failure: Error): void => {
  notifications.show({ color: "red", title: "That was not done", message: failure.message });
};

/** Say what was done, and let it be undone; `undone` is said then. It outlives the row that it was done from. */
export function offerUndo(message: string, undo: () => Promise<unknown>, undone?: string): void {
  const id = notifications.show({
    autoClose: 15_000,
    message: (
      <Group gap="sm" justify="space-between" wrap="nowrap">
        <span style={{ overflowWrap: "anywhere" }}>{message}</span>
        <Button
          size="compact-xs"
          variant="default"
          flex="none"
          onClick={() => {
            notifications.hide(id);
            undo().then(() => undone !== undefined && notifications.show({ color: "teal", message: undone }), tellFailure);
          }}
        >
          Undo
        </Button>
      </Group>
    ),
  });
}

/** What follows putting something into the bin: for a mutation's options. `then` goes where it is no longer seen. */
export const intoBin = (name: string, restore: () => Promise<unknown>, then?: () => void) => ({
  onSuccess: (): void => {
    then?.();
    offerUndo(`${name} moved to the bin.`, restore);
  },
  onError: tellFailure,
});
