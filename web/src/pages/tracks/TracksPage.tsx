import { Button, Title } from "@mantine/core";
import { IconRoute } from "@tabler/icons-react";
import { Link } from "react-router";
import { useRecordings } from "../../api/recordings";
import { useTracks } from "../../api/tracks";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { LoadingRows } from "../parts/LoadingRows";
import { TrackTable } from "../parts/TrackTable";
import { useTitle } from "../parts/useTitle";

export function TracksPage() {
  useTitle("Tracks");
  const { data, error, refetch } = useTracks();
  const recordings = useRecordings().data;
  if (error && !data) return <Failure what="The tracks could not be loaded" error={error} safe="Their files are untouched on the server's disk." onRetry={() => void refetch()} />;
  return (
    <div className="page">
      <Title order={1} mb="lg">
        Tracks
      </Title>
      {!data && <LoadingRows count={6} height={40} />}
      {data?.length === 0 && (
        <EmptyState
          icon={<IconRoute size={48} stroke={1.25} />}
          title="No tracks yet"
          action={
            <Button component={Link} to="/recordings">
              Choose a recording
            </Button>
          }
        >
          A track is a hand fitted to every frame of a recording. Open a recording, annotate its first frame if you like, and start tracking.
        </EmptyState>
      )}
      {data && data.length > 0 && <TrackTable tracks={data} nameOf={(id) => recordings?.find((recording) => recording.id === id)?.name} />}
    </div>
  );
}
