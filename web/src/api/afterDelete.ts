import type { QueryClient, QueryKey } from "@tanstack/react-query";

/** After `id` was deleted: asks anew for what is on the screen, but not for what was deleted, whose page is still there until it is left. */
export async function refreshAfterDelete(client: QueryClient, queryKey: QueryKey, id: string): Promise<void> {
  await client.invalidateQueries({ queryKey, refetchType: "none" });
  await client.refetchQueries({ queryKey, type: "active", predicate: (query) => !query.queryKey.includes(id) });
}
