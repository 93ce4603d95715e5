import { useQuery } from "@tanstack/react-query";
import { useDebouncedValue } from "@mantine/hooks";
import { request } from "./client";
import type { components } from "./schema";
import type { Job } from "./types";
import { jobKeys } from "./jobs";
import type { JobWish } from "./startJob";

type Schemas = components["schemas"];
export type JobCheck = Schemas["JobCheck"];
export type RestartCheck = Schemas["RestartCheck"];
type Refusal = Schemas["BulkRefusal"];

/** Forms ask again this soon after the last change. */
const SETTLED_MS = 200;

/** Recordings that one request may ask about. */
const AT_ONCE = 500;

/** Whether a job can be started: the server answers with the code that starts it. */
export function useJobCheck(wish: JobWish, isWanted: boolean) {
  const asked = JSON.stringify(wish);
  const [settled] = useDebouncedValue(asked, SETTLED_MS);
  return useQuery({
    queryKey: [...jobKeys.checks, settled],
    queryFn: () => request<JobCheck>("POST", "/jobs/check", { body: JSON.parse(settled) as unknown }),
    enabled: isWanted && settled === asked, // what was asked before the page knew its recording is asked of nobody
    placeholderData: (seen) => seen,
    staleTime: 0,
    gcTime: 0,
  });
}

/** A form may be sent unless the server has said that the job would fail; a check that failed itself stops nobody. */
export const mayStart = (check: { data?: JobCheck | undefined; isError: boolean }): boolean => check.data?.can_start ?? check.isError;

/** Why recordings cannot be tracked with these options, by their ids; those that can be are left out. */
export function useBatchCheck(recordings: readonly string[], params: Record<string, unknown>, isWanted: boolean) {
  const [settled] = useDebouncedValue(JSON.stringify(params), SETTLED_MS);
  return useQuery({
    queryKey: [...jobKeys.checks, "batch", recordings, settled],
    queryFn: async () => {
      const found = new Map<string, string>();
      for (let first = 0; first < recordings.length; first += AT_ONCE) {
        const body = { sequence_ids: recordings.slice(first, first + AT_ONCE), params: JSON.parse(settled) as unknown };
        const { refused } = await request<{ refused: Refusal[] }>("POST", "/jobs/batch/check", { body });
        for (const { id, detail } of refused) found.set(id, detail);
      }
      return found;
    },
    enabled: isWanted && recordings.length > 0,
    placeholderData: (seen) => seen,
    staleTime: 0,
    gcTime: 0,
  });
}

/** What is kept of a job that failed or was cancelled, and whether it can go on or be tried again. */
export const useRestartCheck = (job: Job | undefined) =>
  useQuery({
    queryKey: [...jobKeys.checks, "restart", job?.id, job?.state, job?.attempt],
    queryFn: () => request<RestartCheck>("GET", `/jobs/${job?.id}/restart`),
    enabled: job?.state === "failed" || job?.state === "cancelled",
  });
