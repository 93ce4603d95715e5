import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { API, request, upload } from "./client";
import { recordingKeys } from "./recordings";
import type { Import, Recording } from "./types";

/** What a person can say about files that don't say it themselves, by the name of the option. */
export type ImportOptions = Record<string, string | number | boolean | string[]>;

/** A file with its path below the dropped folder. */
export interface DroppedFile {
  path: string;
  file: File;
}

const importKey = (id: string) => ["imports", id] as const;

export const useImport = (id: string) =>
  useQuery({ queryKey: importKey(id), queryFn: () => request<Import>("GET", `/imports/${id}`), retry: false });

/** Names of the formats that can be asked for. */
export const useImportFormats = () =>
  useQuery({
    queryKey: ["import-form"],
    queryFn: async () => (await request<{ formats: string[] }>("GET", "/imports/form")).formats,
    staleTime: Infinity,
  });

export function sendFiles(
  files: readonly DroppedFile[],
  options: ImportOptions,
  onProgress: (part: number) => void,
  signal: AbortSignal,
): Promise<Import> {
  const form = new FormData();
  if (Object.keys(options).length > 0) form.append("options", JSON.stringify(options));
  for (const { path, file } of files) form.append("files", file, path);
  return upload<Import>("/imports", form, onProgress, signal);
}

export function useCheckAgain(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (options: ImportOptions) => request<Import>("POST", `/imports/${id}/check`, { body: { options } }),
    onSuccess: (checked) => client.setQueryData(importKey(id), checked),
  });
}

export function useTakeCameras(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (calibration: string | null) => request<Import>("PUT", `/imports/${id}/calibration`, { body: { calibration_id: calibration } }),
    onSuccess: (checked) => client.setQueryData(importKey(id), checked),
  });
}

export function useConfirmImport(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ name, options }: { name: string; options: ImportOptions }) => request<Recording>("POST", `/imports/${id}/confirm`, { body: { name, options } }),
    onSuccess: () => client.invalidateQueries({ queryKey: recordingKeys.all }),
  });
}

/** A small picture of an image that would come in, by its name in the report. */
export const importPicture = (id: string, name: string): string => `${API}/imports/${id}/picture?name=${encodeURIComponent(name)}`;

export const discardImport = (id: string): Promise<void> => request("DELETE", `/imports/${id}`);
