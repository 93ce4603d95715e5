import { Button, Stack, Text } from "@mantine/core";
import { useQueryClient, type QueryKey } from "@tanstack/react-query";
import { useEffect, type ReactNode } from "react";
import { formatBytes, formatCount } from "../../model/format";
import type { FileUpload } from "../../state/upload";
import { Dialog } from "./Dialog";
import { FormFooter } from "./Obstacles";
import { Sending } from "./Sending";

interface FilesDialogProps<R> {
  title: string;
  size: number;
  upload: FileUpload<R>;
  /** What the files should be. */
  hint: string;
  /** Said while the server reads them: "Every file is opened and checked." */
  reading: string;
  /** What is asked for again when they have arrived. */
  changes: QueryKey;
  onEnd: () => void;
  /** Beside the buttons. */
  note?: ReactNode;
  /** Null: why they cannot be sent is said in the note or the form. */
  onSend: (() => void) | null;
  /** The button that sends: "Add 2 scans". */
  verb: string;
  /** In place of that button. */
  instead?: ReactNode;
  result: (result: R) => ReactNode;
  children: ReactNode;
}

/** What chosen files do not say of themselves, then their way to the server, then what became of them. */
export function FilesDialog<R>({ title, size, upload, hint, reading, changes, onEnd, note, onSend, verb, instead, result, children }: FilesDialogProps<R>) {
  const client = useQueryClient();
  const hasResult = upload.result !== null;
  useEffect(() => {
    if (hasResult) void client.invalidateQueries({ queryKey: changes });
  }, [hasResult, client, changes]);
  const told = `${formatCount(upload.files.length, "file")}, ${formatBytes(upload.bytes)}.`;
  const content =
    upload.result !== null ? (
      result(upload.result)
    ) : upload.sent !== null ? (
      <Sending sent={upload.sent} title={<Text size="sm">{upload.sent === 1 ? reading : `Sending ${told}`}</Text>} onCancel={onEnd} />
    ) : (
      <form
        onSubmit={(event) => {
          event.preventDefault();
          onSend?.();
        }}
      >
        <Stack gap="md">
          <Text size="sm" className="quiet">
            {told} {hint}
          </Text>
          {children}
          <FormFooter failure={upload.failure} failed="Nothing was stored; try again.">
            {note}
            <Button variant="default" onClick={onEnd}>
              Cancel
            </Button>
            {instead || (
              <Button type="submit" disabled={!onSend}>
                {verb}
              </Button>
            )}
          </FormFooter>
        </Stack>
      </form>
    );
  return (
    <Dialog title={title} size={size} onClose={onEnd} isKept>
      {content}
    </Dialog>
  );
}
