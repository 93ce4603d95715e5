import { keepPreviousData, useInfiniteQuery, useMutation, useQuery, useQueryClient, type InfiniteData, type QueryClient } from "@tanstack/react-query";
import { useEffect, useState, useSyncExternalStore } from "react";
import { listen, request } from "./client";
import { liveRoom, noteHeard, streamAddress } from "../state/live";
import { fetchAll, recordingKeys } from "./recordings";
import type { Batch, BatchMade, BulkAct, BulkDone, Job, JobForm, JobState, LogLine, Page, Worker } from "./types";

export const jobKeys = {
  all: ["jobs"] as const,
  one: (id: string) => ["jobs", "one", id] as const,
  /** Every list of jobs, whatever it is filtered by. */
  lists: ["jobs", "list"] as const,
  active: ["jobs", "active"] as const,
  ofRecording: (id: string) => ["jobs", "recording", id] as const,
  batches: ["jobs", "batches"] as const,
  checks: ["jobs", "checks"] as const,
};

export const isActive = (job: Job): boolean => job.state === "queued" || job.state === "running";

const newestFirst = (a: Job, b: Job): number => b.created_at.localeCompare(a.created_at);

/** What a list of jobs is narrowed to; what is left out narrows nothing. */
export interface JobFilters {
  states: JobState[];
  recording?: string | undefined;
  person?: string | undefined;
  batch?: string | undefined;
  search?: string | undefined;
}

const PAGE = 50;

/** Jobs page by page, newest first. */
export const useJobList = (filters: JobFilters) =>
  useInfiniteQuery({
    queryKey: [...jobKeys.lists, filters],
    queryFn: ({ pageParam }) =>
      request<Page<Job>>("GET", "/jobs", {
        query: {
          state: filters.states,
          sequence_id: filters.recording,
          created_by: filters.person,
          batch_id: filters.batch,
          search: filters.search,
          cursor: pageParam,
          limit: PAGE,
        },
      }),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
    placeholderData: keepPreviousData,
  });

/** Those that wait or run. */
export const useActiveJobs = () =>
  useQuery({ queryKey: jobKeys.active, queryFn: () => fetchAll<Job>("/jobs", { state: ["queued", "running"] }) });

export const useRecordingJobs = (recording: string | null) =>
  useQuery({ queryKey: jobKeys.ofRecording(recording ?? ""), enabled: recording !== null, queryFn: () => fetchAll<Job>("/jobs", { sequence_id: recording ?? "" }) });

/** Workers of the last day; asked again and again, since a silent one says nothing. */
export const useWorkers = () =>
  useQuery({
    queryKey: ["workers"],
    queryFn: async () => (await request<Page<Worker>>("GET", "/workers")).items,
    refetchInterval: 3000,
  });

export const useBatches = () =>
  useQuery({
    queryKey: jobKeys.batches,
    queryFn: async () => (await request<Page<Batch>>("GET", "/jobs/batches", { query: { limit: 20 } })).items,
    refetchInterval: (query) => (query.state.data?.some((batch) => !batch.ended_at) ? 2000 : false),
  });

export function useStartBatch() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ recordings, params }: { recordings: readonly string[]; params: Record<string, unknown> }) =>
      request<BatchMade>("POST", "/jobs/batch", { body: { kind: "track", sequence_ids: recordings, params } }),
    onSuccess: () => client.invalidateQueries({ queryKey: jobKeys.all }),
  });
}

/** Cancel, retry or resume several. */
export function useBulkAct() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ act, ids }: { act: BulkAct; ids: readonly string[] }) =>
      request<BulkDone>("POST", "/jobs/bulk", { body: { act, job_ids: ids } }),
    onSettled: () => client.invalidateQueries({ queryKey: jobKeys.all }),
  });
}

export const useJob = (id: string) =>
  useQuery({
    queryKey: jobKeys.one(id),
    queryFn: () => request<Job>("GET", `/jobs/${id}`),
    enabled: id !== "",
    refetchInterval: (query) => (query.state.data && isActive(query.state.data) ? 5000 : false),
  });

const put = (jobs: Job[] | undefined, job: Job): Job[] | undefined => jobs && [job, ...jobs.filter((other) => other.id !== job.id)].sort(newestFirst);

/** Take a job as the server says it is now into everything that shows it. */
export function takeIn(client: QueryClient, job: Job): void {
  const before = client.getQueryData<Job>(jobKeys.one(job.id));
  if (before && before.version > job.version) return;
  client.setQueryData(jobKeys.one(job.id), job);
  client.setQueryData<Job[]>(jobKeys.active, (jobs) => (isActive(job) ? put(jobs, job) : jobs?.filter((other) => other.id !== job.id)));
  if (job.sequence_id) client.setQueryData<Job[]>(jobKeys.ofRecording(job.sequence_id), (jobs) => put(jobs, job));
  client.setQueriesData<InfiniteData<Page<Job>>>({ queryKey: jobKeys.lists }, (list) =>
    list && { ...list, pages: list.pages.map((page) => ({ ...page, items: page.items.map((other) => (other.id === job.id ? job : other)) })) },
  );
  if (before && before.hand_model_id !== job.hand_model_id) void client.invalidateQueries({ queryKey: ["hand-models"] });
  if (before?.state === job.state) return;
  void client.invalidateQueries({ queryKey: jobKeys.lists }); // it may be in other lists now
  void client.invalidateQueries({ queryKey: jobKeys.batches });
  if (!isActive(job)) {
    if (job.moving_scan_id) void client.invalidateQueries({ queryKey: ["moving-scans"] });
    const changed = { scans: ["scans", "registrations", "hand-models", "training-sets", "lineage"], cameras: ["calibrations"], frames: ["tracks"] }[job.unit];
    for (const key of changed) void client.invalidateQueries({ queryKey: [key] });
    void client.invalidateQueries({ queryKey: recordingKeys.all });
  }
}

/** Keep every job in the cache up to date while the app is open; says whether the stream is up. */
export function useJobStream(): boolean {
  const client = useQueryClient();
  const [isUp, setUp] = useState(true);
  const room = useSyncExternalStore(liveRoom.watch, liveRoom.get);
  useEffect(() => {
    const noting = (handle: (data: unknown) => void) => (data: unknown, id: string) => {
      noteHeard(id);
      handle(data);
    };
    const handlers = { ...room?.handlers, job: (data: unknown) => takeIn(client, data as Job) };
    return listen(streamAddress, Object.fromEntries(Object.entries(handlers).map(([event, handle]) => [event, noting(handle)])), (isLinked) => {
      setUp(isLinked);
      if (isLinked) room?.onOpen();
    });
  }, [client, room]);
  return isUp;
}

/** The log of a job as it grows. */
export function useJobLog(id: string, isLive: boolean) {
  const client = useQueryClient();
  return useQuery({
    queryKey: [...jobKeys.one(id), "log", isLive],
    queryFn: async () => {
      const known = client.getQueryData<LogLine[]>([...jobKeys.one(id), "log", isLive]) ?? [];
      const { lines } = await request<{ lines: LogLine[] }>("GET", `/jobs/${id}/log`, { query: { after: known.at(-1)?.n } });
      return [...known, ...lines];
    },
    refetchInterval: isLive ? 1500 : false,
    placeholderData: (seen) => seen, // the lines stay while the last ones come, when the job has ended
  });
}

export const useJobForm = (isWanted: boolean) =>
  useQuery({
    queryKey: ["job-form"],
    queryFn: () => request<JobForm>("GET", "/jobs/form"),
    enabled: isWanted,
    staleTime: 0, // a hand model that was trained since is among its choices
  });

export function useJobAction(action: "cancel" | "retry" | "resume") {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request<Job>("POST", `/jobs/${id}/${action}`),
    onSuccess: (job) => {
      if (job) takeIn(client, job);
      void client.invalidateQueries({ queryKey: jobKeys.lists });
    },
  });
}
