import { Button, Modal, Stack, Title } from "@mantine/core";
import type { ReactNode } from "react";
import { FormFooter, type ObstaclesProps } from "./Obstacles";

interface DialogProps {
  title: string;
  /** px; a small screen is filled. */
  size: number;
  isOpen?: boolean;
  /** Left out: it goes when what it asks for is done, and nothing lies over it. */
  onClose?: () => void;
  /** A click beside it does not close it: something would be lost. */
  isKept?: boolean;
  children: ReactNode;
}

/** The one frame of all dialogs. */
export function Dialog({ title, size, isOpen = true, onClose, isKept = false, children }: DialogProps) {
  const stays = onClose ? { closeOnClickOutside: !isKept } : { withCloseButton: false, closeOnClickOutside: false, closeOnEscape: false, zIndex: 500 };
  return (
    <Modal opened={isOpen} onClose={onClose ?? (() => undefined)} size={size} title={<Title order={2}>{title}</Title>} {...stays}>
      {children}
    </Modal>
  );
}

interface FormDialogProps extends DialogProps, ObstaclesProps {
  onClose: () => void;
  onSubmit: () => void;
  /** What the button does: "Train". */
  verb: string;
  isBusy?: boolean;
  isReady?: boolean;
  /** What it does cannot be undone: leaving is the button at hand, and the other one is red. */
  isGrave?: boolean;
  /** The way out: "Cancel". */
  stay?: string;
  /** Beside the buttons. */
  note?: ReactNode;
  isFocused?: boolean;
}

/** A dialog that does one thing: what it needs to know, what is in the way, and two buttons in sight. */
export function FormDialog({ onClose, onSubmit, verb, isBusy = false, isReady = true, isGrave = false, stay = "Cancel", note, isFocused = false, check, failure, failed, help, children, ...frame }: FormDialogProps) {
  return (
    <Dialog {...frame} onClose={onClose}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (isReady && !isBusy) onSubmit();
        }}
      >
        <Stack gap="md">
          {children}
          <FormFooter check={check} failure={failure} failed={failed} help={help}>
            {note}
            <Button variant="default" onClick={onClose} data-autofocus={isGrave || undefined}>
              {stay}
            </Button>
            <Button type="submit" loading={isBusy} disabled={!isReady} {...(isGrave ? { color: "red" } : {})} data-autofocus={isFocused || undefined}>
              {verb}
            </Button>
          </FormFooter>
        </Stack>
      </form>
    </Dialog>
  );
}
