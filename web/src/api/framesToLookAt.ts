import { keepPreviousData, useInfiniteQuery } from "@tanstack/react-query";
import { request } from "./client";
import { AGAIN_MS, flagKeys } from "./flags";
import type { QueuePage } from "./types";

const PAGE = 24;

/** The hands that most need a person, page after page, the worst first. Known to change with the flags. */
export const useFramesToLookAt = (recording: string) =>
  useInfiniteQuery({
    queryKey: [...flagKeys.of(recording), "frames"],
    queryFn: ({ pageParam, signal }) => request<QueuePage>("GET", `/sequences/${recording}/frames-to-look-at`, { query: { cursor: pageParam, limit: PAGE }, signal }),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
    refetchInterval: ({ state }) => (state.data?.pages[0]?.is_behind ? AGAIN_MS : false),
    placeholderData: keepPreviousData,
  });
