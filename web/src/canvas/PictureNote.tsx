import { Button, Text } from "@mantine/core";
import type { Setback } from "./frameCache";
import classes from "./ImagePane.module.css";

interface PictureNoteProps {
  frame: number;
  shownFrame: number | null;
  hasPicture: boolean;
  setback: Setback | null;
  onRetry: () => void;
  /** Somebody tried to change something meanwhile: say so at once. */
  isRefused: boolean;
}

/** Says that the picture is not the wanted one, and why; nothing while it is. */
export function PictureNote({ frame, shownFrame, hasPicture, setback, onRetry, isRefused }: PictureNoteProps) {
  const isHere = shownFrame === frame && hasPicture;
  if (isHere && !setback) return null;
  const shown = hasPicture && !isHere ? `You see frame ${shownFrame}. ` : "";
  const safe = "Marks made so far are safe.";
  return (
    <div className={classes.note} data-picture-note data-over-picture data-at-once={isRefused || setback !== null} data-refused={isRefused} role="status">
      <Text size="sm" fw={600}>
        {setback ? `${isHere ? "A" : "The"} picture of frame ${frame} could not be loaded` : `Waiting for the picture of frame ${frame}`}
      </Text>
      <Text size="xs">
        {shown}
        {setback ? `${setback.error.message} ${setback.isForGood ? safe : `It is asked for again by itself. ${safe}`}` : `${isRefused ? "That had no effect: nothing" : "Nothing"} can be changed until it is here.`}
      </Text>
      {setback && (
        <Button size="compact-xs" variant="default" mt={8} onClick={onRetry}>
          Try now
        </Button>
      )}
    </div>
  );
}
