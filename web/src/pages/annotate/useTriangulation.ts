import { queryOptions, useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useMemo } from "react";
import { fetchTriangulation, type MarkedView, type TriangulatedJoint, type Triangulation } from "../../api/triangulation";
import { canTriangulate, markedViews } from "../../model/triangulated";
import { useAnnotating } from "./annotating";
import { useAnnotation, useOpenRecording } from "./reading";

/** The same marks always make the same joints, so an answer is never asked for twice. */
const triangulationOf = (recording: string, views: readonly MarkedView[]) =>
  queryOptions({
    queryKey: ["triangulation", recording, JSON.stringify(views)],
    queryFn: ({ signal }) => fetchTriangulation(recording, views, signal),
    staleTime: Infinity,
    gcTime: 60_000,
    retry: 1,
  });

interface Found {
  /** Of the active hand in this frame; null when no joint is marked in two views. */
  joints: readonly TriangulatedJoint[] | null;
  /** The answer for the marks as they are at this moment, with those marks; null when no joint is marked in two views. */
  fetchNow: () => Promise<{ found: Triangulation; views: readonly MarkedView[] } | null>;
}

export function useTriangulation(): Found {
  const { recording, session } = useAnnotating();
  const { id, cameras } = useOpenRecording();
  const client = useQueryClient();
  const poses = useAnnotation((state) => state.poses);
  const frame = useAnnotation((state) => state.frame);
  const hand = useAnnotation((state) => state.hand);
  const views = useMemo(() => (cameras.length > 1 ? markedViews(poses, cameras.map((camera) => camera.id), frame, hand) : []), [cameras, poses, frame, hand]);
  const isPossible = canTriangulate(views);
  const query = useQuery({
    ...triangulationOf(id, views),
    enabled: isPossible,
  });
  const fetchNow = useCallback(async () => {
    const now = session.store.get();
    const opened = recording.get();
    const marked = markedViews(now.poses, opened.cameras.map((camera) => camera.id), now.frame, now.hand);
    if (!canTriangulate(marked)) return null;
    return { found: await client.fetchQuery(triangulationOf(opened.id, marked)), views: marked };
  }, [client, recording, session]);
  return { joints: isPossible && query.data ? query.data.joints : null, fetchNow };
}
