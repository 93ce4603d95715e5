import { ActionIcon, Tooltip } from "@mantine/core";
import { IconArrowsHorizontal, IconZoomIn, IconZoomOut } from "@tabler/icons-react";
import { wholeWindow, zoomWindow, type FrameWindow } from "../../canvas/frameWindow";
import { useAnnotating } from "./annotating";
import classes from "./Timeline.module.css";
import { TimelineLegend } from "./TimelineLegend";

interface TimelineToolsProps {
  window: FrameWindow;
  frameCount: number;
  hasTrack: boolean;
  onWindow: (window: FrameWindow) => void;
}

/** Which part of the timeline is seen, and what its marks mean. */
export function TimelineTools({ window: shown, frameCount, hasTrack, onWindow }: TimelineToolsProps) {
  const { session } = useAnnotating();
  const isWhole = shown.count >= frameCount;
  const zoom = (factor: number): void => onWindow(zoomWindow(shown, factor, (session.store.get().frame + 0.5 - shown.from) / shown.count, frameCount));
  return (
    <div className={classes.tools}>
      <Tooltip label="Closer (wheel)">
        <ActionIcon size={24} aria-label="Zoom the timeline in" onClick={() => zoom(2)}>
          <IconZoomIn size={15} />
        </ActionIcon>
      </Tooltip>
      <Tooltip label="Farther">
        <ActionIcon size={24} aria-label="Zoom the timeline out" onClick={() => zoom(0.5)}>
          <IconZoomOut size={15} />
        </ActionIcon>
      </Tooltip>
      <Tooltip label={isWhole ? "All frames are shown" : "All frames"}>
        <ActionIcon size={24} aria-label="Show all frames" aria-disabled={isWhole} data-disabled={isWhole || undefined} onClick={() => onWindow(wholeWindow(frameCount))}>
          <IconArrowsHorizontal size={15} />
        </ActionIcon>
      </Tooltip>
      <TimelineLegend hasTrack={hasTrack} />
    </div>
  );
}
