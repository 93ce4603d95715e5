import { Button } from "@mantine/core";
import { useEffect, useMemo } from "react";
import { Link, useParams, useSearchParams } from "react-router";
import { ApiError } from "../../api/client";
import { useRecording } from "../../api/recordings";
import { forgetPlace } from "../../state/lastPlace";
import { scopeOf } from "../../state/saving";
import { Annotator } from "./Annotator";
import { AnnotatorSkeleton } from "./AnnotatorSkeleton";
import { useSession } from "./useSession";
import { Failure } from "../parts/Failure";
import { useTitle } from "../parts/useTitle";

/** `?camera=&frame=&hand=` says where; the page keeps it up to date. With `?replica=` one marks blindly: no track is shown. */
export default function AnnotatePage() {
  const { recordingId } = useParams();
  const { data: recording, error, refetch } = useRecording(recordingId);
  const [address] = useSearchParams();
  const replica = address.get("replica");
  const { session, failure, retry } = useSession(recording, () => ({
    camera: address.get("camera"),
    frame: Number(address.get("frame") ?? 0) || 0,
    hand: address.get("hand") === "left" ? "left" : address.get("hand") === "right" ? "right" : recording?.hands[0] === "left" ? "left" : "right",
  }), replica);
  const shown = useMemo(() => recording && (replica ? { ...recording, best_track: null } : recording), [recording, replica]);
  useTitle(recording ? `Annotate ${recording.name}` : "Annotate");
  const isMissing = error instanceof ApiError && error.status === 404;
  useEffect(() => {
    if (isMissing) forgetPlace();
  }, [isMissing]);

  if (error && !recording) {
    return (
      <Failure what="This recording could not be opened" error={error} safe="Annotations that were still waiting are kept in this browser." onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/recordings">
          To the recordings
        </Button>
      </Failure>
    );
  }
  if (failure) return <Failure what="The annotations could not be loaded" error={failure} safe="They are untouched on the server." onRetry={retry} />;
  if (!recording || !shown || !session) return <AnnotatorSkeleton />;
  return <Annotator key={scopeOf(recording.id, replica)} recording={shown} session={session} replica={replica} />;
}
