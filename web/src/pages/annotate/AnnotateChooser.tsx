import { SimpleGrid, Skeleton, Text, Title } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";
import { Link, Navigate } from "react-router";
import { thumbnailUrl, useRecordings } from "../../api/recordings";
import { lastPlace } from "../../state/lastPlace";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ImportButton } from "../parts/ImportButton";
import { Thumbnail } from "../parts/Thumbnail";
import { useTitle } from "../parts/useTitle";
import { workText } from "../parts/WorkProgress";
import classes from "./AnnotateChooser.module.css";

/** "Annotate" without a recording: back to the last one, or a choice. */
export default function AnnotateChooser() {
  useTitle("Annotate");
  const { data, error, refetch } = useRecordings();
  if (error && !data) return <Failure what="The recordings could not be loaded" error={error} onRetry={() => void refetch()} />;
  if (!data) {
    return (
      <div className="page">
        <Skeleton height={32} width={320} mb="lg" />
        <SimpleGrid cols={{ base: 2, lg: 3 }}>
          {Array.from({ length: 6 }, (_, index) => (
            <Skeleton key={index} height={88} />
          ))}
        </SimpleGrid>
      </div>
    );
  }
  const last = lastPlace();
  if (last && data.some((recording) => last.startsWith(`/recordings/${recording.id}/`))) return <Navigate to={last} replace />;
  if (data.length === 0) {
    return (
      <EmptyState icon={<IconPencil size={48} stroke={1.25} />} title="Nothing to annotate yet" action={<ImportButton label="Import a recording" />}>
        Annotating means marking the 21 joints of a hand in an image. Import a recording first, or drop one anywhere.
      </EmptyState>
    );
  }
  return (
    <div className="page">
      <Title order={1} mb="lg">
        Which recording?
      </Title>
      <SimpleGrid cols={{ base: 2, lg: 3 }} spacing="md">
        {data.map((recording) => (
          <Link key={recording.id} to={`/recordings/${recording.id}/annotate`} className={`card ${classes.row}`}>
            <Thumbnail src={thumbnailUrl(recording, recording.cameras[0]?.id ?? "", 0)} alt="" width={112} height={80} className={classes.picture} />
            <div style={{ minWidth: 0 }}>
              <Text fw={600} className="one-line">
                {recording.name}
              </Text>
              <Text size="sm" className="quiet">
                {workText(recording.done_frames, recording.annotated_frames - recording.done_frames, recording.frame_count)}
              </Text>
            </div>
          </Link>
        ))}
      </SimpleGrid>
    </div>
  );
}
