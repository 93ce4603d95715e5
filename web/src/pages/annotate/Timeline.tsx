import { ActionIcon, Tooltip } from "@mantine/core";
import { IconArrowsHorizontal, IconZoomIn, IconZoomOut } from "@tabler/icons-react";
import { useEffect, useMemo, useState } from "react";
import { goToFrame } from "../../actions/annotate/select";
import { useTrackFrames } from "../../api/tracks";
import { lanesOf } from "../../canvas/drawTimeline";
import { wholeWindow, windowWith, zoomWindow } from "../../canvas/frameWindow";
import { TimelineStrip } from "../../canvas/TimelineStrip";
import { mergeMarks } from "../../model/frameMarks";
import { describeFrame, handFrames, withSuggested } from "../../model/frameStates";
import { trackRows } from "../../model/trackRows";
import { useAnnotating } from "./annotating";
import { MARKS } from "./mounts";
import classes from "./Timeline.module.css";
import { TimelineLegend } from "./TimelineLegend";
import { useKeyFrames, useSuggestions } from "./useSession";

/** Every frame of the recording with what is known about it. */
export function Timeline() {
  const { recording, session, state, act } = useAnnotating();
  const { frame_count: frameCount } = recording;
  const [shown, setWindow] = useState(() => wholeWindow(frameCount));
  const keys = useKeyFrames(session);
  const suggestions = useSuggestions(session);
  const track = useTrackFrames(recording.best_track?.id).data;
  const rows = useMemo(() => (track ? trackRows(track, frameCount) : []), [track, frameCount]);
  const sources = MARKS.map((useMarks) => useMarks());
  // Every source keeps its answer as long as nothing changes.
  const marks = useMemo(() => mergeMarks(sources), sources);
  const annotated = useMemo(() => handFrames(state.poses, keys, frameCount, state.camera), [state.poses, keys, frameCount, state.camera]);
  const hands = useMemo(
    () => withSuggested(annotated, state.poses, suggestions.byPlace, suggestions.hidden, state.camera),
    [annotated, state.poses, suggestions, state.camera],
  );
  const asked = useMemo(() => (state.frames ? new Set(state.frames) : null), [state.frames]);
  const content = useMemo(() => ({ hands, rows, marks, frameCount, asked }), [hands, rows, marks, frameCount, asked]);
  // The window turns its page when the frame leaves it; a person may look elsewhere meanwhile.
  useEffect(() => setWindow((now) => windowWith(now, state.frame, frameCount)), [state.frame, frameCount]);

  const share = (state.frame + 0.5 - shown.from) / shown.count;
  const isWhole = shown.count >= frameCount;
  return (
    <div className={classes.timeline}>
      <div className={classes.labels} aria-hidden>
        {lanesOf(content).lanes.map(({ label, top, height }) => (
          <span key={label} style={{ top, height }}>
            {label}
          </span>
        ))}
      </div>
      <TimelineStrip
        content={content}
        frame={state.frame}
        window={shown}
        onWindow={setWindow}
        onSeek={(frame) => act(goToFrame, frame)}
        describe={(frame) => describeFrame(frame, hands, marks)}
      />
      <div className={classes.tools}>
        <Tooltip label="Closer (wheel)">
          <ActionIcon size={24} aria-label="Zoom the timeline in" onClick={() => setWindow(zoomWindow(shown, 2, share, frameCount))}>
            <IconZoomIn size={15} />
          </ActionIcon>
        </Tooltip>
        <Tooltip label="Farther">
          <ActionIcon size={24} aria-label="Zoom the timeline out" onClick={() => setWindow(zoomWindow(shown, 0.5, share, frameCount))}>
            <IconZoomOut size={15} />
          </ActionIcon>
        </Tooltip>
        <Tooltip label={isWhole ? "All frames are shown" : "All frames"}>
          <ActionIcon size={24} aria-label="Show all frames" aria-disabled={isWhole} data-disabled={isWhole || undefined} onClick={() => setWindow(wholeWindow(frameCount))}>
            <IconArrowsHorizontal size={15} />
          </ActionIcon>
        </Tooltip>
        <TimelineLegend hasTrack={rows.length > 0} />
      </div>
    </div>
  );
}
