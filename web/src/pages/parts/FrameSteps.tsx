import { IconChevronLeft, IconChevronRight, IconPlayerPause, IconPlayerPlay } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { KeyIcon } from "./KeyIcon";

interface FrameStepsProps {
  isPlaying: boolean;
  canPlay?: boolean;
  /** Their names in the key map. */
  actions: { play: string; previous: string; next: string };
  onPlay: () => void;
  onStep: (by: 1 | -1) => void;
  /** Which frame it is. */
  children: ReactNode;
}

/** Play, one frame back, one frame on. */
export function FrameSteps({ isPlaying, canPlay = true, actions, onPlay, onStep, children }: FrameStepsProps) {
  return (
    <>
      <KeyIcon label={isPlaying ? "Pause" : "Play"} action={actions.play} disabled={!canPlay} onClick={onPlay}>
        {isPlaying ? <IconPlayerPause size={18} /> : <IconPlayerPlay size={18} />}
      </KeyIcon>
      <KeyIcon label="Previous frame" action={actions.previous} onClick={() => onStep(-1)}>
        <IconChevronLeft size={18} />
      </KeyIcon>
      {children}
      <KeyIcon label="Next frame" action={actions.next} onClick={() => onStep(1)}>
        <IconChevronRight size={18} />
      </KeyIcon>
    </>
  );
}
