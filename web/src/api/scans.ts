/** Scans of hands: uploaded files, what is cropped from them, their points for the 3D view. */

import { keepPreviousData, useInfiniteQuery, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { HandGeometry } from "../canvas/hand3d/geometry";
import { uprightByShape } from "../model/upright";
import { API, fetchBytes, request, requestWithHeaders, upload } from "./client";
import { dequantise, readGeometry } from "./geometryFile";
import type { DroppedFile } from "./imports";
import type { components } from "./schema";
import type { Page, Side } from "./types";

type Schemas = components["schemas"];
export type Scan = Schemas["ScanOut"];
export type ScanCollection = Schemas["CollectionOut"];
export type ScansAdded = Schemas["ScansAdded"];
export type ScansMeasured = Schemas["ScansMeasured"];
export type ScanMeasure = Schemas["ScanMeasure"];
export type ScanCrop = Schemas["ScanCrop"];
export type ScanCropRevision = Schemas["ScanCropOut"];

/** What a list of scans is narrowed to; what is left out narrows nothing. */
export interface ScanFilters {
  collection?: string | undefined;
  subject?: string | undefined;
  side?: Side | undefined;
  state?: Scan["state"] | undefined;
  search?: string | undefined;
}

export const scanKeys = {
  all: ["scans"] as const,
  one: (id: string) => ["scans", "one", id] as const,
};

const PAGE = 60;
/** Points of a scan that are drawn. */
export const POINTS = 20_000;

export const useScanList = (filters: ScanFilters) =>
  useInfiniteQuery({
    queryKey: [...scanKeys.all, "list", filters],
    queryFn: ({ pageParam }) => request<Page<Scan>>("GET", "/scans", { query: { ...filters, cursor: pageParam, limit: PAGE } }),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
    placeholderData: keepPreviousData,
  });

export const useScanCollections = () =>
  useQuery({
    queryKey: [...scanKeys.all, "collections"],
    queryFn: async () => (await request<Page<ScanCollection>>("GET", "/scans/collections")).items,
  });

export const useScan = (id: string) => useQuery({ queryKey: scanKeys.one(id), queryFn: ({ signal }) => request<Scan>("GET", `/scans/${id}`, { signal }) });

const cropKey = (scan: Pick<Scan, "id" | "revision"> | undefined) => [...scanKeys.one(scan?.id ?? ""), "crop", scan?.revision] as const;

export const useScanCrop = (scan: Scan | undefined) =>
  useQuery({
    queryKey: cropKey(scan),
    queryFn: () => request<ScanCropRevision>("GET", `/scans/${scan?.id}/crop`),
    enabled: scan !== undefined,
  });

/** `onSaved` is called with the scan as it is now, before anything is drawn from it. */
export function useSaveCrop(onSaved: (scan: Scan) => void) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ scan, crop }: { scan: Scan; crop: ScanCrop }) =>
      requestWithHeaders<Scan>("PUT", `/scans/${scan.id}/crop`, { body: crop, headers: { "If-Match": `"${scan.revision}"` } }),
    onSuccess: ({ data }, { crop }) => {
      // Known before it is asked for, so that what was cropped stays on the screen.
      client.setQueryData<ScanCropRevision>(cropKey(data), { ...crop, drops_objects: crop.drops_objects ?? false, revision: data.revision, removed_count: data.removed_count, metres_per_unit: data.metres_per_unit, author_name: null, created_at: null });
      client.setQueryData(scanKeys.one(data.id), data);
      onSaved(data);
    },
    onSettled: () => void client.invalidateQueries({ queryKey: scanKeys.all }),
  });
}

export function useChangeScan() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ id, ...body }: { id: string } & Schemas["ScanPatch"]) => request<Scan>("PATCH", `/scans/${id}`, { body }),
    onSettled: () => client.invalidateQueries({ queryKey: scanKeys.all }),
  });
}

/** Say or correct the unit of scans, one after the other; each must still be as it is known here. */
export function useChangeUnits() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: async ({ scans, metresPerUnit }: { scans: readonly Pick<Scan, "id" | "revision">[]; metresPerUnit: number }) => {
      for (const { id, revision } of scans) {
        const body = { metres_per_unit: metresPerUnit };
        await request<Scan>("PUT", `/scans/${id}/unit`, { body, headers: { "If-Match": `"${revision}"` } });
      }
    },
    onSettled: () => Promise.all([client.invalidateQueries({ queryKey: scanKeys.all }), client.invalidateQueries({ queryKey: ["registrations"] })]),
  });
}

export function useDeleteScans() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (ids: readonly string[]) => Promise.all(ids.map((id) => request("DELETE", `/scans/${id}`))),
    onSettled: () => client.invalidateQueries({ queryKey: scanKeys.all }),
  });
}

/** What scan files do not say of themselves. */
export interface ScanUploadOptions {
  collection?: string;
  subject?: string;
  pose?: string;
  side?: Side | null;
  metres_per_unit?: number | null;
  /** By file, where it is another. */
  units?: Record<string, number>;
}

export function sendScans(files: readonly DroppedFile[], options: ScanUploadOptions, onProgress: (part: number) => void, signal: AbortSignal): Promise<ScansAdded> {
  const form = writeForm(files);
  form.append("options", JSON.stringify(options));
  return upload<ScansAdded>("/scans", form, onProgress, signal);
}

/** How large the scans in some files are; nothing is stored. */
export const measureScans = (files: readonly DroppedFile[], onProgress: (part: number) => void, signal: AbortSignal): Promise<ScansMeasured> =>
  upload<ScansMeasured>("/scans/measure", writeForm(files), onProgress, signal);

function writeForm(files: readonly DroppedFile[]): FormData {
  const form = new FormData();
  for (const { path, file } of files) form.append("files", file, path);
  return form;
}

export const scanFileUrl = (scan: { id: string }): string => `${API}/scans/${scan.id}/file`;

/** Bits of `flags`. */
const LEFT_OUT = 3;

type ScanPlace = Pick<Scan, "id" | "geometry_key">;

export const scanThumbnailUrl = (scan: ScanPlace): string => `${API}/scans/${scan.id}/thumbnail/${scan.geometry_key}.png`;

/** The points of a scan, with nothing fitted to them. */
export async function fetchScanGeometry(scan: ScanPlace, side: Side | null, signal?: AbortSignal): Promise<HandGeometry> {
  const { data } = await fetchBytes(`${API}/scans/${scan.id}/geometry/${scan.geometry_key}?size=${POINTS}`, signal);
  const { arrays, facts } = readGeometry(data);
  const positions = dequantise(arrays["positions"] ?? [], facts["origin_m"] as number[], facts["step_m"] as number[]);
  const flags = arrays["flags"] as Uint8Array | undefined;
  return {
    scan: {
      positions,
      normals: (arrays["normals"] as Int8Array | undefined) ?? null,
      colors: (arrays["colors"] as Uint8Array | undefined) ?? null,
      index: null,
      errorMm: null,
      taken: flags ? flags.map((bits) => (bits & LEFT_OUT ? 1 : 0)) : null,
    },
    mesh: null,
    side,
    upright: uprightByShape(positions),
  };
}
