import { SimpleGrid, Title } from "@mantine/core";
import { errorOf, useEvaluation, useTrack } from "../../api/tracks";
import { formatNumber } from "../../model/format";
import { Fact } from "../parts/Fact";

/** What a job made, in figures. */
export function JobResult({ trackId }: { trackId: string }) {
  const track = useTrack(trackId).data;
  const evaluation = useEvaluation(trackId).data;
  if (!track) return null;
  const { summary } = track;
  return (
    <section aria-label="Result">
      <Title order={2} mb="sm">
        Result
      </Title>
      <SimpleGrid cols={{ base: 2, sm: 5 }} spacing="md" mb="lg">
        <Fact label="Lost frames">{summary.lost}</Fact>
        <Fact label="Error, px">{formatNumber(errorOf(evaluation), 2)}</Fact>
        <Fact label="Depth residual, mm">{formatNumber(summary.depth_residual_mm, 2)}</Fact>
        <Fact label="Silhouette IoU">{formatNumber(summary.silhouette_iou, 3)}</Fact>
        <Fact label="Median of a frame, ms">{formatNumber(summary.median_ms)}</Fact>
      </SimpleGrid>
    </section>
  );
}
