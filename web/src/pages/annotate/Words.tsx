import { Button, TextInput } from "@mantine/core";
import { useState } from "react";
import classes from "./AssignmentBar.module.css";

interface WordsProps {
  label: string;
  isBusy: boolean;
  mayBeEmpty: boolean;
  onSend: (text: string) => void;
  onCancel: () => void;
}

/** A line to write in, in the bar itself: nothing covers the picture. */
export function Words({ label, isBusy, mayBeEmpty, onSend, onCancel }: WordsProps) {
  const [text, setText] = useState("");
  const isReady = text.trim() !== "" || mayBeEmpty;
  return (
    <form
      className={classes.words}
      onSubmit={(event) => {
        event.preventDefault();
        if (isReady) onSend(text.trim());
      }}
    >
      <TextInput
        size="xs"
        autoFocus
        flex={1}
        maxLength={4000}
        aria-label={label}
        placeholder={label}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key === "Escape") onCancel();
          if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) event.currentTarget.form?.requestSubmit();
        }}
      />
      <Button size="compact-xs" type="submit" loading={isBusy} disabled={!isReady}>
        Send
      </Button>
      <Button size="compact-xs" variant="default" onClick={onCancel}>
        Cancel
      </Button>
    </form>
  );
}
