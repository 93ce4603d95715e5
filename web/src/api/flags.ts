import { keepPreviousData, useInfiniteQuery, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { request } from "./client";
import type { Flag, FlagPage } from "./types";

export const flagKeys = { of: (recording: string) => ["flags", recording] as const };

const PAGE = 24;
/** The annotator walks through so many, the worst ones. */
const WALK = 1000;

/** A check that labels have overtaken is asked for again after a while. */
export const AGAIN_MS = 5000;
const askAgain = (page: FlagPage | undefined): number | false => (page?.checked.is_behind ? AGAIN_MS : false);

const fetchFlags = (recording: string, query: Record<string, string | number | null | undefined>, signal: AbortSignal): Promise<FlagPage> =>
  request<FlagPage>("GET", `/sequences/${recording}/flags`, { query, signal });

/** Page after page, the worst first. */
export const useFlagPages = (recording: string, kind: string | null, isDismissed: boolean) =>
  useInfiniteQuery({
    queryKey: [...flagKeys.of(recording), "pages", kind, isDismissed],
    queryFn: ({ pageParam, signal }) => fetchFlags(recording, { kind, dismissed: String(isDismissed), cursor: pageParam, limit: PAGE }, signal),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
    refetchInterval: ({ state }) => askAgain(state.data?.pages[0]),
    placeholderData: keepPreviousData,
  });

export const useFlags = (recording: string) =>
  useQuery({
    queryKey: [...flagKeys.of(recording), "all"],
    queryFn: ({ signal }) => fetchFlags(recording, { limit: WALK }, signal),
    refetchInterval: ({ state }) => askAgain(state.data),
    placeholderData: keepPreviousData,
  });

/** Say that a label is right, or take it back. */
export function useDismissal(recording: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ flag, isRight }: { flag: Flag; isRight: boolean }) => {
      const path = `/sequences/${recording}/flags/${encodeURIComponent(flag.camera)}/${flag.frame}/${flag.hand}/${flag.kind}/dismissal`;
      return isRight ? request("PUT", path, { body: { revision: flag.revision } }) : request("DELETE", path, { query: { revision: flag.revision } });
    },
    onSettled: () => client.invalidateQueries({ queryKey: flagKeys.of(recording) }),
  });
}
