import { Button } from "@mantine/core";
import { Link, useParams } from "react-router";
import { useRecording } from "../../api/recordings";
import { useTrack, useTrackFrames } from "../../api/tracks";
import { Failure } from "../parts/Failure";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { TrackReview } from "./TrackReview";

/** `?frame=&camera=&tab=` says where; the page keeps it up to date. */
export default function TrackPage() {
  const { trackId = "" } = useParams();
  const track = useTrack(trackId);
  const frames = useTrackFrames(trackId);
  const recording = useRecording(track.data?.sequence_id);
  useTitle(track.data ? `${track.data.name} of ${recording.data?.name ?? "…"}` : "Track");
  const error = track.error ?? frames.error ?? recording.error;
  if (error && !(track.data && frames.data && recording.data)) {
    return (
      <Failure
        what="This track could not be loaded"
        error={error}
        safe="Tracks are files on the server's disk; nothing was changed."
        onRetry={() => {
          void track.refetch();
          void frames.refetch();
          void recording.refetch();
        }}
      >
        <Button variant="default" component={Link} to="/tracks">
          To the tracks
        </Button>
      </Failure>
    );
  }
  if (!track.data || !frames.data || !recording.data) return <PageSkeleton />;
  return <TrackReview key={trackId} track={track.data} frames={frames.data} recording={recording.data} />;
}
