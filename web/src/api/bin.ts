/** What was deleted, the way back, and the way out for good. */

import { useInfiniteQuery, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { request } from "./client";
import type { components } from "./schema";
import type { Page } from "./types";

export type BinItem = components["schemas"]["BinItem"];
export type BinErasure = components["schemas"]["BinErasure"];

const binKey = ["bin"] as const;

export const useBin = (kind: string | null) =>
  useInfiniteQuery({
    queryKey: [...binKey, kind],
    queryFn: ({ pageParam }) => request<Page<BinItem>>("GET", "/bin", { query: { kind, cursor: pageParam, limit: 50 } }),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
  });

/** Bring things back, one or several of a kind. */
export function useRestore() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ kind, ids }: { kind: BinItem["kind"]; ids: readonly string[] }) => Promise.all(ids.map((id) => request("POST", `/bin/${kind}/${id}/restore`))),
    onSettled: () => client.invalidateQueries(), // whatever lists it anywhere
  });
}

/** What goes with a thing when it is deleted for good; asked anew each time. */
export const useErasure = (item: Pick<BinItem, "kind" | "id"> | null) =>
  useQuery({
    queryKey: [...binKey, "erasure", item?.kind, item?.id],
    queryFn: () => request<BinErasure>("GET", `/bin/${item?.kind}/${item?.id}/erasure`),
    enabled: item !== null,
    gcTime: 0,
  });

export function useErase() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ kind, id }: Pick<BinItem, "kind" | "id">) => request("DELETE", `/bin/${kind}/${id}`),
    onSettled: () => client.invalidateQueries(),
  });
}
