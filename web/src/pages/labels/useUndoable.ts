import { useRestoreSnapshot, type Snapshot } from "../../api/labels";
import { offerUndo } from "../parts/undo";

/** Says what was done to a recording's labels and offers the way back: the snapshot that was kept before it. */
export function useUndoable(recording: string): (what: string, before: Snapshot) => void {
  const { mutateAsync } = useRestoreSnapshot(recording);
  return (what, before) => offerUndo(what, () => mutateAsync(before.id), "Undone: the labels are as they were before.");
}
