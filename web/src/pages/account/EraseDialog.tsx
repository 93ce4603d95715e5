import { List, Skeleton, Text } from "@mantine/core";
import { FormDialog } from "../parts/Dialog";
import { notifications } from "@mantine/notifications";
import { useErase, useErasure, type BinItem } from "../../api/bin";
import { formatBytes, formatCount } from "../../model/format";

interface EraseDialogProps {
  /** Null: closed. */
  item: BinItem | null;
  onClose: () => void;
}

/** Names what goes with a thing before it is deleted for good: this is the one act here that nothing undoes. */
export function EraseDialog({ item, onClose }: EraseDialogProps) {
  const erasure = useErasure(item);
  const erase = useErase();
  const told = erasure.data;
  const error = erasure.error ?? erase.error;
  const close = (): void => {
    erase.reset();
    onClose();
  };
  return (
    <FormDialog
      title="Delete for good?"
      size={480}
      isOpen={item !== null}
      onClose={close}
      onSubmit={() =>
        item &&
        erase.mutate(item, {
          onSuccess: () => {
            notifications.show({ message: `${item.name} is deleted for good.` });
            close();
          },
        })
      }
      verb="Delete for good"
      stay="Keep it"
      isGrave
      isBusy={erase.isPending}
      isReady={told !== undefined && told.obstacle === null}
      failure={error}
      failed="Nothing was deleted."
    >
      <Text size="sm" style={{ overflowWrap: "anywhere" }}>
        The {item?.word} <strong>{item?.name}</strong> is deleted, and cannot be restored.
      </Text>
      {!told && !error && <Skeleton height={72} role="status" aria-label="What goes with it is counted" />}
      {told && told.obstacle === null && (
        <div>
          <Text size="sm" mb={4}>
            With it:
          </Text>
          <List size="sm" spacing={4} aria-label="What goes">
            {told.going.map(({ word, count }) => (
              <List.Item key={word}>{formatCount(count, word)}</List.Item>
            ))}
            <List.Item>{told.byte_count > 0 ? `${formatBytes(told.byte_count)} of files` : "no files on this machine"}</List.Item>
          </List>
        </div>
      )}
      {told && told.obstacle !== null && (
        <Text size="sm" c="var(--warn-text)" role="status">
          It cannot be deleted: {told.obstacle}.
        </Text>
      )}
    </FormDialog>
  );
}
