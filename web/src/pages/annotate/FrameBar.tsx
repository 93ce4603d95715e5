import { ActionIcon, Group, NumberInput, SegmentedControl, Select, Text, Tooltip } from "@mantine/core";
import { IconChevronLeft, IconChevronRight, IconPlayerPause, IconPlayerPlay } from "@tabler/icons-react";
import type { RefObject } from "react";
import { Link } from "react-router";
import type { Recording } from "../../api/types";
import { arrangementsOf, type Arrangement } from "../../state/viewOptions";
import classes from "./Annotator.module.css";

interface FrameBarProps {
  recording: Recording;
  camera: string;
  frame: number;
  isPlaying: boolean;
  arrangement: Arrangement;
  frameField: RefObject<HTMLInputElement | null>;
  run: (action: string) => void;
  onFrame: (frame: number) => void;
  onCamera: (camera: string) => void;
  onArrangement: (arrangement: Arrangement) => void;
}

const NAMES: Record<Arrangement, string> = { color: "Colour", depth: "Depth", side: "Side by side", over: "Depth over colour" };

/** Which recording, camera and frame, and which pictures of it. */
export function FrameBar({ recording, camera, frame, isPlaying, arrangement, frameField, run, onFrame, onCamera, onArrangement }: FrameBarProps) {
  const here = recording.cameras.find((one) => one.id === camera);
  const arrangements = here ? arrangementsOf(here) : [];
  return (
    <div className={classes.bar}>
      <Link to={`/recordings/${recording.id}`} className={`${classes.title} one-line`} title={recording.name}>
        {recording.name}
      </Link>
      {recording.cameras.length > 1 && (
        <Select size="xs" w={136} aria-label="Camera" allowDeselect={false} data={recording.cameras.map((one) => one.id)} value={camera} onChange={(id) => id && onCamera(id)} />
      )}
      {arrangements.length > 1 && (
        <SegmentedControl
          size="xs"
          aria-label="Pictures"
          data={arrangements.map((value) => ({ value, label: NAMES[value] }))}
          value={arrangement}
          onChange={(value) => onArrangement(value as Arrangement)}
        />
      )}
      <Group gap={4} ml="auto" wrap="nowrap">
        <Tooltip label={isPlaying ? "Pause (Space)" : "Play (Space)"}>
          <ActionIcon aria-label={isPlaying ? "Pause" : "Play"} onClick={() => run("play")}>
            {isPlaying ? <IconPlayerPause size={18} /> : <IconPlayerPlay size={18} />}
          </ActionIcon>
        </Tooltip>
        <Tooltip label="Previous frame (D)">
          <ActionIcon aria-label="Previous frame" onClick={() => run("frame.previous")}>
            <IconChevronLeft size={18} />
          </ActionIcon>
        </Tooltip>
        <NumberInput
          ref={frameField}
          size="xs"
          w={72}
          aria-label="Frame"
          className={classes.frameField}
          hideControls
          allowDecimal={false}
          allowNegative={false}
          max={recording.frame_count - 1}
          value={frame}
          onChange={(value) => typeof value === "number" && onFrame(value)}
          onKeyDown={(event) => (event.key === "Enter" || event.key === "Escape") && event.currentTarget.blur()}
        />
        <Text size="xs" className="quiet" style={{ whiteSpace: "nowrap" }}>
          of 0–{recording.frame_count - 1}
        </Text>
        <Tooltip label="Next frame (F)">
          <ActionIcon aria-label="Next frame" onClick={() => run("frame.next")}>
            <IconChevronRight size={18} />
          </ActionIcon>
        </Tooltip>
      </Group>
    </div>
  );
}
