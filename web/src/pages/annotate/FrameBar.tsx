import { Group, NumberInput, SegmentedControl, Select, Text } from "@mantine/core";
import { useRef } from "react";
import { Link } from "react-router";
import { goToFrame, selectCamera } from "../../actions/annotate/select";
import { arrangementsOf, type Arrangement } from "../../state/viewOptions";
import { FrameSteps } from "../parts/FrameSteps";
import { useActions, useAnnotating } from "./annotating";
import classes from "./Annotator.module.css";
import { FRAME_TOOLS } from "./mounts";
import { useAnnotation, useArrangement, useCamera, useOpenRecording, usePage } from "./reading";

const NAMES: Record<Arrangement, string> = { color: "Colour", depth: "Depth", side: "Side by side", over: "Depth over colour" };

const STEPS = { play: "play", previous: "frame.previous", next: "frame.next" } as const;

/** The frame's number, to read and to go to another one. */
function FrameField() {
  const { act } = useAnnotating();
  const { frame_count: frameCount } = useOpenRecording();
  const frame = useAnnotation((state) => state.frame);
  const field = useRef<HTMLInputElement>(null);
  useActions({ "frame.goto": () => field.current?.select() });
  return (
    <NumberInput
      ref={field}
      size="xs"
      w={72}
      aria-label="Frame"
      className={classes.frameField}
      hideControls
      allowDecimal={false}
      allowNegative={false}
      max={frameCount - 1}
      value={frame}
      onChange={(value) => typeof value === "number" && act(goToFrame, value)}
      onKeyDown={(event) => (event.key === "Enter" || event.key === "Escape") && event.currentTarget.blur()}
    />
  );
}

/** Which recording, camera and frame, and which pictures of it. */
export function FrameBar() {
  const { setOptions, act, run } = useAnnotating();
  const recording = useOpenRecording();
  const camera = useCamera();
  const arrangement = useArrangement();
  const isPlaying = usePage((page) => page.isPlaying);
  const arrangements = arrangementsOf(camera);
  return (
    <div className={classes.bar}>
      <Link to={`/recordings/${recording.id}`} className={`${classes.title} one-line`} title={recording.name}>
        {recording.name}
      </Link>
      {recording.cameras.length > 1 && (
        <Select size="xs" w={136} aria-label="Camera" allowDeselect={false} data={recording.cameras.map((one) => one.id)} value={camera.id} onChange={(id) => id && act(selectCamera, id)} />
      )}
      {arrangements.length > 1 && (
        <SegmentedControl
          size="xs"
          className={classes.arrange}
          aria-label="Pictures"
          data={arrangements.map((value) => ({ value, label: NAMES[value] }))}
          value={arrangement}
          onChange={(value) => setOptions({ arrangement: value })}
        />
      )}
      {FRAME_TOOLS.map((FrameTool, index) => (
        <FrameTool key={index} />
      ))}
      <Group gap={4} ml="auto" wrap="nowrap" className={classes.frames}>
        <FrameSteps isPlaying={isPlaying} actions={STEPS} onPlay={() => run(STEPS.play)} onStep={(by) => run(by > 0 ? STEPS.next : STEPS.previous)}>
          <FrameField />
          <Text size="xs" className="quiet" style={{ whiteSpace: "nowrap" }}>
            of 0–{recording.frame_count - 1}
          </Text>
        </FrameSteps>
      </Group>
    </div>
  );
}
