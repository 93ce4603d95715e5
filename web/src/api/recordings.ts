import { useMutation, useQuery, useQueryClient, type QueryClient } from "@tanstack/react-query";
import { refreshAfterDelete } from "./afterDelete";
import { API, request, requestWithHeaders } from "./client";
import type { Page, Recording } from "./types";

export const recordingKeys = {
  all: ["recordings"] as const,
  one: (id: string) => ["recordings", id] as const,
};

/** Every recording, page after page; a studio holds hundreds, not millions. */
export async function fetchAll<T>(path: string, query: Record<string, string | number | readonly string[] | undefined> = {}): Promise<T[]> {
  const items: T[] = [];
  let cursor: string | null = null;
  do {
    const page: Page<T> = await request("GET", path, { query: { limit: 100, ...query, cursor } });
    items.push(...page.items);
    cursor = page.next_cursor;
  } while (cursor);
  return items;
}

export const useRecordings = () =>
  useQuery({ queryKey: recordingKeys.all, queryFn: () => fetchAll<Recording>("/sequences") });

export const useRecording = (id: string | undefined) =>
  useQuery({
    queryKey: recordingKeys.one(id ?? ""),
    queryFn: ({ signal }) => request<Recording>("GET", `/sequences/${id}`, { signal }),
    enabled: Boolean(id),
  });

const refresh = (client: QueryClient) => client.invalidateQueries({ queryKey: recordingKeys.all });

export function useRenameRecording(recording: Recording) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (name: string) =>
      requestWithHeaders<Recording>("PATCH", `/sequences/${recording.id}`, {
        body: { name },
        headers: { "If-Match": `"${recording.revision}"` },
      }),
    onSuccess: ({ data }) => client.setQueryData(recordingKeys.one(recording.id), data),
    onSettled: () => refresh(client),
  });
}

export function useDeleteRecording() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (recording: Recording) =>
      request("DELETE", `/sequences/${recording.id}`, { headers: { "If-Match": `"${recording.revision}"` } }),
    onSuccess: (_, { id }) => refreshAfterDelete(client, recordingKeys.all, id),
  });
}

const framePath = (recording: Recording, camera: string, frame: number): string =>
  `${API}/sequences/${recording.id}/${recording.content_key}/cameras/${encodeURIComponent(camera)}/frames/${frame}`;

/** One immutable address for each picture. */
export const colorUrl = (recording: Recording, camera: string, frame: number): string => `${framePath(recording, camera, frame)}/color.jpg`;
/** Depth in colours, for cameras without others. */
export const depthPictureUrl = (recording: Recording, camera: string, frame: number): string => `${framePath(recording, camera, frame)}/depth.png`;
export const depthUrl = (recording: Recording, camera: string, frame: number): string => `${framePath(recording, camera, frame)}/depth.bin`;
export const thumbnailUrl = (recording: Recording, camera: string, frame: number): string =>
  `${framePath(recording, camera, frame)}/thumbnail.jpg`;
