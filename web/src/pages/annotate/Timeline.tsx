import { useEffect, useMemo, useState } from "react";
import { goToFrame } from "../../actions/annotate/select";
import { useTrackFrames } from "../../api/tracks";
import { lanesOf, type TimelineContent } from "../../canvas/drawTimeline";
import { wholeWindow, windowWith, type FrameWindow } from "../../canvas/frameWindow";
import { TimelineStrip } from "../../canvas/TimelineStrip";
import { describeFrame, handFrames, withSuggested } from "../../model/frameStates";
import { trackRows } from "../../model/trackRows";
import { useAnnotating } from "./annotating";
import { useMarks } from "./mounts";
import { useAnnotation, useKeyFrames, useOpenRecording, useSuggestions } from "./reading";
import classes from "./Timeline.module.css";
import { TimelineTools } from "./TimelineTools";

/** What is known of every frame of the active camera. */
function useContent(): { content: TimelineContent; describe: (frame: number) => readonly string[] } {
  const { best_track: best, frame_count: frameCount } = useOpenRecording();
  const camera = useAnnotation((state) => state.camera);
  const poses = useAnnotation((state) => state.poses);
  const frames = useAnnotation((state) => state.frames);
  const keys = useKeyFrames((now) => now);
  const byPlace = useSuggestions((state) => state.byPlace);
  const hidden = useSuggestions((state) => state.hidden);
  const marks = useMarks();
  const track = useTrackFrames(best?.id).data;
  const rows = useMemo(() => (track ? trackRows(track, frameCount) : []), [track, frameCount]);
  const annotated = useMemo(() => handFrames(poses, keys, frameCount, camera), [poses, keys, frameCount, camera]);
  const hands = useMemo(() => withSuggested(annotated, poses, byPlace, hidden, camera), [annotated, poses, byPlace, hidden, camera]);
  return useMemo(
    () => ({
      content: { hands, rows, marks, frameCount, asked: frames ? new Set(frames) : null },
      describe: (frame) => describeFrame(frame, hands, marks),
    }),
    [hands, rows, marks, frameCount, frames],
  );
}

interface StripProps extends ReturnType<typeof useContent> {
  window: FrameWindow;
  onWindow: (change: (now: FrameWindow) => FrameWindow) => void;
}

/** The strip itself, which follows the frame. */
function Strip({ content, describe, window: shown, onWindow }: StripProps) {
  const { act } = useAnnotating();
  const frame = useAnnotation((state) => state.frame);
  const { frameCount } = content;
  // The window turns its page when the frame leaves it; a person may look elsewhere meanwhile.
  useEffect(() => onWindow((now) => windowWith(now, frame, frameCount)), [onWindow, frame, frameCount]);
  return <TimelineStrip content={content} frame={frame} window={shown} onWindow={(next) => onWindow(() => next)} onSeek={(to) => act(goToFrame, to)} describe={describe} />;
}

/** Every frame of the recording with what is known about it. */
export function Timeline() {
  const { content, describe } = useContent();
  const { frameCount } = content;
  const [shown, setWindow] = useState(() => wholeWindow(frameCount));
  return (
    <div className={classes.timeline}>
      <div className={classes.labels} aria-hidden>
        {lanesOf(content).lanes.map(({ label, top, height }) => (
          <span key={label} style={{ top, height }}>
            {label}
          </span>
        ))}
      </div>
      <Strip content={content} describe={describe} window={shown} onWindow={setWindow} />
      <TimelineTools window={shown} frameCount={frameCount} hasTrack={content.rows.length > 0} onWindow={setWindow} />
    </div>
  );
}
