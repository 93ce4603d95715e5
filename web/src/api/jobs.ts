import { useMutation, useQuery, useQueryClient, type QueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { listen, request } from "./client";
import { fetchAll, recordingKeys } from "./recordings";
import type { Job, JobForm, LogLine } from "./types";

export const jobKeys = {
  all: ["jobs"] as const,
  one: (id: string) => ["jobs", id] as const,
};

export const isActive = (job: Job): boolean => job.state === "queued" || job.state === "running";

const newestFirst = (a: Job, b: Job): number => b.created_at.localeCompare(a.created_at);

export const useJobs = () =>
  useQuery({
    queryKey: jobKeys.all,
    queryFn: async () => (await fetchAll<Job>("/jobs")).sort(newestFirst),
    // The event stream is faster; this only helps when a proxy swallows it.
    refetchInterval: (query) => (query.state.data?.some(isActive) ? 5000 : false),
  });

export const useJob = (id: string) =>
  useQuery({
    queryKey: jobKeys.one(id),
    queryFn: () => request<Job>("GET", `/jobs/${id}`),
    refetchInterval: (query) => (query.state.data && isActive(query.state.data) ? 5000 : false),
  });

function takeIn(client: QueryClient, job: Job): void {
  const before = client.getQueryData<Job>(jobKeys.one(job.id));
  client.setQueryData(jobKeys.one(job.id), job);
  client.setQueryData<Job[]>(jobKeys.all, (jobs) =>
    jobs && [job, ...jobs.filter((other) => other.id !== job.id)].sort(newestFirst),
  );
  if (!isActive(job) && before?.state !== job.state) {
    void client.invalidateQueries({ queryKey: ["tracks"] });
    void client.invalidateQueries({ queryKey: recordingKeys.all });
  }
}

/** Keep every job in the cache up to date while the app is open; says whether the stream is up. */
export function useJobStream(): boolean {
  const client = useQueryClient();
  const [isUp, setUp] = useState(true);
  useEffect(() => listen("/jobs/events", { job: (data) => takeIn(client, data as Job) }, setUp), [client]);
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
  });
}

export const useJobForm = (isWanted: boolean) =>
  useQuery({
    queryKey: ["job-form"],
    queryFn: () => request<JobForm>("GET", "/jobs/form"),
    enabled: isWanted,
    staleTime: Infinity,
  });

export function useStartTracking() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ sequenceId, params }: { sequenceId: string; params: Record<string, unknown> }) =>
      request<Job>("POST", "/jobs", { body: { kind: "track", sequence_id: sequenceId, params } }),
    onSuccess: (job) => takeIn(client, job),
  });
}

export function useJobAction(action: "cancel" | "retry" | "resume") {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request<Job>("POST", `/jobs/${id}/${action}`),
    onSuccess: (job) => {
      if (job) takeIn(client, job);
      void client.invalidateQueries({ queryKey: jobKeys.all });
    },
  });
}
