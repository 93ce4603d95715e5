import { useMemo } from "react";
import { goToFrame } from "../../actions/annotate/select";
import { useTrackFrames } from "../../api/tracks";
import { FrameStrip } from "../../canvas/FrameStrip";
import { annotationRows } from "../../model/annotationRows";
import { trackRows } from "../../model/trackRows";
import { useAnnotating } from "./annotating";
import classes from "./Annotator.module.css";

/** Every frame of the recording with what is known about it. */
export function Timeline() {
  const { recording, state, act } = useAnnotating();
  const track = useTrackFrames(recording.best_track?.id).data;
  const trackStrip = useMemo(() => (track ? trackRows(track, recording.frame_count) : []), [track, recording.frame_count]);
  const rows = useMemo(
    () => [...annotationRows(state.poses, recording.frame_count, state.camera), ...trackStrip],
    [state.poses, recording.frame_count, state.camera, trackStrip],
  );
  return (
    <div className={classes.timeline}>
      <FrameStrip rows={rows} frameCount={recording.frame_count} frame={state.frame} height={rows.length > 2 ? 48 : 32} label="Timeline" onSeek={(frame) => act(goToFrame, frame)} />
    </div>
  );
}
