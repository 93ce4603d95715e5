/** Moving scans: uploaded, registered frame by frame, decided about by stretch, kept. */

import { keepPreviousData, useInfiniteQuery, useMutation, useQueries, useQuery, useQueryClient, type QueryClient } from "@tanstack/react-query";
import type { Surface } from "../canvas/hand3d/geometry";
import { refreshAfterDelete } from "./afterDelete";
import { API, fetchBytes, request, upload } from "./client";
import { dequantise, readGeometry } from "./geometryFile";
import type { DroppedFile } from "./imports";
import { isActive, jobKeys } from "./jobs";
import { fetchAll } from "./recordings";
import type { components } from "./schema";
import type { Job, Page } from "./types";

type Schemas = components["schemas"];
export type MovingScan = Schemas["MovingScanOut"];
export type MovingScanAdded = Schemas["MovingScanAdded"];
export type MovingRegistration = Schemas["MovingRegistrationOut"];
export type FrameRegistration = Schemas["FrameRegistrationOut"];
export type StretchDecision = Schemas["StretchDecisionOut"];
export type AcceptedFrames = Schemas["AcceptedFrames"];
export type BodySet = Schemas["BodySetOut"];
export type PersonModel = Schemas["PersonModelOut"];
export type Prior = MovingRegistration["prior"];

export interface MovingScanOptions {
  name?: string;
  subject?: string;
  fps?: number;
  metres_per_unit?: number;
}

export const movingKeys = {
  all: ["moving-scans"] as const,
  one: (id: string) => ["moving-scans", "one", id] as const,
};

/** While a job is at work its frames are asked for this often. */
const REFRESH_MS = 2000;

export const useMovingScans = (search: string | undefined) =>
  useInfiniteQuery({
    queryKey: [...movingKeys.all, "list", search],
    queryFn: ({ pageParam }) => request<Page<MovingScan>>("GET", "/moving-scans", { query: { search, cursor: pageParam, limit: 60 } }),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
    placeholderData: keepPreviousData,
  });

export const useMovingScan = (id: string) => useQuery({ queryKey: movingKeys.one(id), queryFn: () => request<MovingScan>("GET", `/moving-scans/${id}`) });

/** Jobs that register it, the newest first. */
export const useMovingJobs = (id: string) =>
  useQuery({
    queryKey: [...jobKeys.all, "moving", id],
    queryFn: () => fetchAll<Job>("/jobs", { moving_scan_id: id }),
    refetchInterval: (query) => (query.state.data?.some(isActive) ? REFRESH_MS : false),
  });

/** Registrations, the newest first. `isGrowing`: a job adds frames. */
export const useMovingRegistrations = (id: string, isGrowing: boolean) =>
  useQuery({
    queryKey: [...movingKeys.one(id), "registrations"],
    queryFn: async () => (await request<Page<MovingRegistration>>("GET", `/moving-scans/${id}/registrations`)).items,
    refetchInterval: isGrowing ? REFRESH_MS : false,
  });

/** Frames of some registrations, one list for each, as far as they are there. */
export const useRegisteredFrames = (id: string, registrations: readonly string[], isGrowing: boolean): readonly (readonly FrameRegistration[])[] =>
  useQueries({
    queries: registrations.map((registration) => ({
      queryKey: [...movingKeys.one(id), "frames", registration],
      queryFn: async () => (await request<Schemas["FrameRegistrations"]>("GET", `/moving-registrations/${registration}/frames`)).frames,
      refetchInterval: isGrowing ? REFRESH_MS : (false as const),
    })),
    combine: listFound,
  });

const NONE: readonly FrameRegistration[] = [];
const listFound = (results: readonly { data: readonly FrameRegistration[] | undefined }[]) => results.map(({ data }) => data ?? NONE);

export const useStretchDecisions = (id: string) =>
  useQuery({
    queryKey: [...movingKeys.one(id), "decisions"],
    queryFn: async () => (await request<Page<StretchDecision>>("GET", `/moving-scans/${id}/decisions`)).items,
  });

export const useAcceptedFrames = (id: string) =>
  useQuery({ queryKey: [...movingKeys.one(id), "accepted"], queryFn: () => request<AcceptedFrames>("GET", `/moving-scans/${id}/accepted`) });

export const useBodySets = (id: string) =>
  useQuery({
    queryKey: [...movingKeys.one(id), "sets"],
    queryFn: async () => (await request<Page<BodySet>>("GET", "/body-sets", { query: { moving_scan_id: id } })).items,
  });

const refresh = (client: QueryClient, id: string) => client.invalidateQueries({ queryKey: movingKeys.one(id) });

/** Accept or reject frames; the answer's id takes it back. */
export function useDecideStretch(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ registration, ...body }: { registration: string } & Pick<Schemas["StretchDecisionMake"], "decision" | "first_frame" | "last_frame">) =>
      request<StretchDecision>("POST", `/moving-registrations/${registration}/decisions`, { body: { ...body, operation_id: crypto.randomUUID() } }),
    onSettled: () => refresh(client, id),
  });
}

export function useUndoStretch(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (decision: string) => request<StretchDecision>("POST", `/stretch-decisions/${decision}/undo`, { body: { operation_id: crypto.randomUUID() } }),
    onSettled: () => refresh(client, id),
  });
}

export function useKeepAccepted(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (name: string) => request<BodySet>("POST", "/body-sets", { body: { moving_scan_id: id, name } }),
    onSettled: () => refresh(client, id),
  });
}

/** Models of the person of a moving scan, the newest first. */
export const usePersonModels = (id: string) =>
  useQuery({
    queryKey: [...movingKeys.one(id), "models"],
    queryFn: () => fetchAll<PersonModel>("/person-models", { moving_scan_id: id }),
  });

export function useMakePersonModel(id: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (set: string) => request<PersonModel>("POST", `/body-sets/${set}/model`),
    onSettled: () => refresh(client, id),
  });
}

export function useDeleteMovingScan() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request("DELETE", `/moving-scans/${id}`),
    onSettled: (_answer, _failure, id) => refreshAfterDelete(client, movingKeys.all, id),
  });
}

export function useRestoreMovingScan() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request("POST", `/bin/moving_scan/${id}/restore`),
    onSettled: () => client.invalidateQueries({ queryKey: movingKeys.all }),
  });
}

export function sendMovingScan(files: readonly DroppedFile[], options: MovingScanOptions, onProgress: (part: number) => void, signal: AbortSignal): Promise<MovingScanAdded> {
  const form = new FormData();
  for (const { path, file } of files) form.append("files", file, path);
  form.append("options", JSON.stringify(options));
  return upload<MovingScanAdded>("/moving-scans", form, onProgress, signal);
}

export const movingThumbnailUrl = (id: string): string => `${API}/moving-scans/${id}/thumbnail.png`;
export const personModelUrl = (id: string, kind: "npz" | "pkl"): string => `${API}/person-models/${id}/smplh.${kind}`;
export const bodySetUrl = (id: string): string => `${API}/body-sets/${id}/archive.zip`;

/** A frame as it is drawn: the scan, and the body that was laid onto it when there is one. */
export interface FrameGeometry {
  readonly scan: Surface;
  readonly mesh: Surface | null;
  /** That the body is of. */
  readonly registration: string | null;
}

/** What nothing was compared with comes as not-a-number and goes to the 3D view as -1. */
const knownErrors = (errors: Float32Array): Float32Array => errors.map((error) => (Number.isNaN(error) ? -1 : error));

/** RGB of the body, and of a hand that a frame does not show. */
const BODY_TINT = [214, 150, 84] as const;
const GUESSED_TINT = [150, 92, 255] as const;

function tintOf(guessed: Uint8Array): Uint8Array {
  const tint = new Uint8Array(3 * guessed.length);
  guessed.forEach((isGuessed, vertex) => tint.set(isGuessed ? GUESSED_TINT : BODY_TINT, 3 * vertex));
  return tint;
}

/** The points of a frame, and the body of a registration over them. */
export async function fetchFrame(scan: string, frame: number, registration: string | null, faces: Uint32Array, signal: AbortSignal): Promise<FrameGeometry> {
  const [scanned, fitted] = await Promise.all([
    fetchBytes(`${API}/moving-scans/${scan}/frames/${frame}/geometry`, signal),
    registration === null ? null : fetchBytes(`${API}/moving-registrations/${registration}/frames/${frame}/geometry`, signal),
  ]);
  const { arrays, facts } = readGeometry(scanned.data);
  const body = fitted && readGeometry(fitted.data).arrays;
  const points: Surface = {
    positions: dequantise(arrays["positions"] ?? [], facts["origin_m"] as number[], facts["step_m"] as number[]),
    normals: (arrays["normals"] as Int8Array | undefined) ?? null,
    colors: (arrays["colors"] as Uint8Array | undefined) ?? null,
    index: null,
    errorMm: body ? knownErrors(body["point_error_mm"] as Float32Array) : null,
    taken: null,
  };
  if (!body) return { scan: points, mesh: null, registration };
  const mesh: Surface = {
    positions: body["vertices"] as Float32Array,
    normals: body["normals"] as Int8Array,
    colors: tintOf(body["guessed"] as Uint8Array),
    index: faces,
    errorMm: knownErrors(body["vertex_error_mm"] as Float32Array),
    taken: null,
  };
  return { scan: points, mesh, registration };
}
