/** What was deleted, and the way back. */

import { useInfiniteQuery, useMutation, useQueryClient } from "@tanstack/react-query";
import { request } from "./client";
import type { components } from "./schema";
import type { Page } from "./types";

export type BinItem = components["schemas"]["BinItem"];

const binKey = ["bin"] as const;

export const useBin = (kind: string | null) =>
  useInfiniteQuery({
    queryKey: [...binKey, kind],
    queryFn: ({ pageParam }) => request<Page<BinItem>>("GET", "/bin", { query: { kind, cursor: pageParam, limit: 50 } }),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
  });

export function useRestore() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ kind, id }: Pick<BinItem, "kind" | "id">) => request("POST", `/bin/${kind}/${id}/restore`),
    onSettled: () => client.invalidateQueries(), // whatever lists it anywhere
  });
}
