/** Hand models, the training sets they learn from, and where each thing comes from. */

import { useMutation, useQuery, useQueryClient, type QueryClient } from "@tanstack/react-query";
import { patternOf, type Pattern } from "../model/upright";
import { refreshAfterDelete } from "./afterDelete";
import { API, fetchBytes, request } from "./client";
import { readGeometry } from "./geometryFile";
import { fetchAll } from "./recordings";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type HandModel = Schemas["HandModelOut"];
export type TrainingSet = Schemas["TrainingSetOut"];
export type TrainingRule = Schemas["TrainingRule"];
export type TrainingPreview = Schemas["TrainingPreview"];
export type Lineage = Schemas["Lineage"];
export type LineageItem = Schemas["LineageItem"];
export type LineageKind = LineageItem["kind"];

/** How thoroughly a model is judged on people kept for testing. */
export type Evaluate = Schemas["TrainCreate"]["evaluate"];

export const modelKeys = { all: ["hand-models"] as const, sets: ["training-sets"] as const };

export const useHandModels = () => useQuery({ queryKey: modelKeys.all, queryFn: () => fetchAll<HandModel>("/hand-models") });

export const useHandModel = (id: string | undefined) =>
  useQuery({ queryKey: [...modelKeys.all, id], queryFn: () => request<HandModel>("GET", `/hand-models/${id}`), enabled: Boolean(id) });

export const useModelReport = (model: HandModel | undefined) =>
  useQuery({
    queryKey: [...modelKeys.all, model?.id, "report"],
    queryFn: async () => (await request<Schemas["HandModelReport"]>("GET", `/hand-models/${model?.id}/report`)).report,
    enabled: model?.has_report === true,
  });

export const useTrainingSets = () => useQuery({ queryKey: modelKeys.sets, queryFn: () => fetchAll<TrainingSet>("/training-sets") });

export const useTrainingPreview = (rule: TrainingRule, isWanted: boolean) =>
  useQuery({
    queryKey: [...modelKeys.sets, "preview", rule],
    queryFn: () => request<TrainingPreview>("POST", "/training-sets/preview", { body: rule }),
    enabled: isWanted,
  });

export const useLineage = (kind: LineageKind, id: string | undefined) =>
  useQuery({ queryKey: ["lineage", kind, id], queryFn: () => request<Lineage>("GET", `/lineage/${kind}/${id}`), enabled: Boolean(id) });

export const modelFileUrl = (id: string): string => `${API}/hand-models/${id}/model.npz`;

/** One page with all plots. */
export const reportFileUrl = (id: string): string => `${API}/hand-models/${id}/report.html`;

/** As `smplx` loads it. */
export const manoFileUrl = (id: string, side: "right" | "left"): string => `${API}/hand-models/${id}/mano/${side}`;

export const verifyTrainingSet = (id: string): Promise<Schemas["TrainingVerification"]> => request("GET", `/training-sets/${id}/verify`);
export const trainingSetUrl = (id: string): string => `${API}/training-sets/${id}/registrations.zip`;

/** Vertices of a model at rest, its joints, and the tips of its fingers from thumb to little. */
export interface ModelGeometry {
  readonly vertices: Float32Array;
  readonly faces: Uint32Array;
  readonly joints: Float32Array;
  readonly tips: readonly number[];
  /** (V, 3, S) row by row, m for one standard deviation; empty without. */
  readonly shapes: Float32Array;
  readonly shapeCount: number;
}

export async function fetchModelGeometry(id: string): Promise<ModelGeometry> {
  const { data } = await fetchBytes(`${API}/hand-models/${id}/geometry`);
  const { arrays, facts } = readGeometry(data);
  return {
    vertices: arrays["vertices"] as Float32Array,
    faces: arrays["faces"] as Uint32Array,
    joints: arrays["joints"] as Float32Array,
    tips: [...(arrays["tips"] ?? [])],
    shapes: arrays["shape_directions"] as Float32Array,
    shapeCount: Number(facts["shape_count"]),
  };
}

const geometryQuery = (id: string) => ({ queryKey: [...modelKeys.all, id, "geometry"], queryFn: () => fetchModelGeometry(id), staleTime: Infinity });

export const useModelGeometry = (id: string | undefined) => useQuery({ ...geometryQuery(id ?? ""), enabled: Boolean(id) });

const patterns = new WeakMap<ModelGeometry, Pattern>();

/** Which way up registrations by a model are shown; null when that cannot be known. */
export async function fetchPattern(client: QueryClient, modelId: string): Promise<Pattern | null> {
  const geometry = await client.fetchQuery(geometryQuery(modelId)).catch(() => null);
  if (geometry?.tips.length !== 5) return null;
  const pattern = patterns.get(geometry) ?? patternOf(geometry.vertices, geometry.joints, geometry.tips);
  patterns.set(geometry, pattern);
  return pattern;
}

export function useHideModel() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request("DELETE", `/hand-models/${id}`),
    onSuccess: (_, id) => refreshAfterDelete(client, modelKeys.all, id),
  });
}
