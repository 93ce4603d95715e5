import { SimpleGrid, Skeleton, Title } from "@mantine/core";
import { errorOf, useEvaluation, useTrack } from "../../api/tracks";
import { formatNumber } from "../../model/format";
import { Fact } from "../parts/Fact";

/** What a job made, in figures. */
export function JobResult({ trackId }: { trackId: string }) {
  const { data: track, isPending } = useTrack(trackId);
  const evaluation = useEvaluation(trackId);
  if (isPending) return <Skeleton height={96} radius="lg" mb="lg" role="status" aria-label="The result is loaded" />;
  if (!track) return null;
  const { summary } = track;
  return (
    <section aria-label="Result">
      <Title order={2} mb="sm">
        Result
      </Title>
      <SimpleGrid cols={{ base: 2, sm: 5 }} spacing="md" mb="lg">
        <Fact label="Lost frames">{summary.lost}</Fact>
        <Fact label="Error, px">{evaluation.isPending ? <Skeleton height={20} my={4} w={48} /> : formatNumber(errorOf(evaluation.data), 2)}</Fact>
        <Fact label="Depth residual, mm">{formatNumber(summary.depth_residual_mm, 2)}</Fact>
        <Fact label="Silhouette IoU">{formatNumber(summary.silhouette_iou, 3)}</Fact>
        <Fact label="Median of a frame, ms">{formatNumber(summary.median_ms)}</Fact>
      </SimpleGrid>
    </section>
  );
}
