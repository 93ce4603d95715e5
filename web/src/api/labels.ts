import { useMutation, useQuery, useQueryClient, type QueryClient } from "@tanstack/react-query";
import { API, request, upload } from "./client";
import type { DroppedFile } from "./imports";
import { fetchAll, recordingKeys } from "./recordings";
import type { components } from "./schema";
import type { Side } from "./types";

type Schemas = components["schemas"];
export type Snapshot = Schemas["SnapshotOut"];
export type LabelFormat = Schemas["LabelFormatOut"];
export type HandChange = Schemas["HandChangeOut"];
export type LabelComparison = Schemas["LabelComparison"];
export type LabelImportReport = Schemas["LabelImportReport"];
export type LabelImportDone = Schemas["LabelImportDone"];

/** What files of labels may not say. */
export interface LabelImportOptions {
  format?: string | null;
  hand?: Side | null;
  camera?: string | null;
  pixel_centre?: 0 | 0.5 | null;
  joint_order?: string | null;
}

export type Policy = "keep" | "replace";

const keys = {
  snapshots: (recording: string) => ["labels", recording, "snapshots"] as const,
  all: (recording: string) => ["labels", recording] as const,
};

/** Labels were changed by other means than the annotator. */
async function refresh(client: QueryClient, recording: string): Promise<void> {
  await Promise.all([
    client.invalidateQueries({ queryKey: keys.all(recording) }),
    client.invalidateQueries({ queryKey: ["annotations"] }),
    client.invalidateQueries({ queryKey: recordingKeys.all }),
  ]);
}

export const useLabelFormats = () =>
  useQuery({
    queryKey: ["label-formats"],
    queryFn: () => request<Schemas["LabelFormats"]>("GET", "/label-formats"),
    staleTime: Infinity,
  });

export const useSnapshots = (recording: string) =>
  useQuery({
    queryKey: keys.snapshots(recording),
    queryFn: () => fetchAll<Snapshot>(`/sequences/${recording}/labels/snapshots`),
    enabled: Boolean(recording),
  });

export function useCreateSnapshot(recording: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (name: string) => request<Snapshot>("POST", `/sequences/${recording}/labels/snapshots`, { body: { name } }),
    onSuccess: () => client.invalidateQueries({ queryKey: keys.snapshots(recording) }),
  });
}

export const useComparison = (recording: string, snapshot: string | null, other: string) =>
  useQuery({
    queryKey: [...keys.all(recording), "compare", snapshot, other],
    queryFn: () => request<LabelComparison>("GET", `/snapshots/${snapshot}/compare`, { query: { with: other } }),
    enabled: Boolean(snapshot),
    retry: false,
  });

export function useRestoreSnapshot(recording: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request<Schemas["SnapshotRestored"]>("POST", `/snapshots/${id}/restore`),
    onSuccess: () => refresh(client, recording),
  });
}

export const verifySnapshot = (id: string): Promise<Schemas["SnapshotVerification"]> => request("GET", `/snapshots/${id}/verify`);

export const snapshotFileUrl = (id: string): string => `${API}/snapshots/${id}/labels.json`;

export interface ExportChoice {
  format: string;
  source: readonly string[];
  snapshot_id?: string | undefined;
  track_id?: string | undefined;
}

export function exportUrl(recording: string, choice: ExportChoice): string {
  const known = Object.entries(choice).flatMap(([name, value]: [string, string | readonly string[] | undefined]) => (value ? [value].flat().map((one) => [name, one]) : []));
  return `${API}/sequences/${recording}/labels/export?${new URLSearchParams(known)}`;
}

export const useExportNotes = (recording: string, choice: ExportChoice) =>
  useQuery({
    queryKey: [...keys.all(recording), "notes", choice],
    queryFn: () => request<Schemas["ExportNotes"]>("GET", `/sequences/${recording}/labels/export/notes`, { query: { ...choice } }),
    retry: false,
  });

function pack(files: readonly DroppedFile[], options: LabelImportOptions, more: Record<string, string> = {}): FormData {
  const form = new FormData();
  form.append("options", JSON.stringify(options));
  for (const [name, value] of Object.entries(more)) form.append(name, value);
  for (const { path, file } of files) form.append("files", file, path);
  return form;
}

export interface LabelUpload {
  files: readonly DroppedFile[];
  options: LabelImportOptions;
}

const send = <T>(path: string, form: FormData): Promise<T> => upload<T>(path, form, () => undefined, new AbortController().signal);

export const useCheckLabels = (recording: string) =>
  useMutation({
    mutationFn: ({ files, options }: LabelUpload) =>
      send<LabelImportReport>(`/sequences/${recording}/labels/check`, pack(files, options)),
  });

export function useImportLabels(recording: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ files, options, check, policy }: LabelUpload & { check: string; policy: Policy }) =>
      send<LabelImportDone>(`/sequences/${recording}/labels/import`, pack(files, options, { check, policy })),
    onSuccess: () => refresh(client, recording),
  });
}
