/** Hand models, the training sets they learn from, where each thing comes from, and the jobs that make them. */

import { useMutation, useQuery, useQueryClient, type QueryClient } from "@tanstack/react-query";
import { patternOf, type Pattern } from "../model/upright";
import { refreshAfterDelete } from "./afterDelete";
import { API, fetchBytes, request } from "./client";
import { readGeometry } from "./geometryFile";
import { jobKeys } from "./jobs";
import { fetchAll } from "./recordings";
import { registrationKeys } from "./registrations";
import type { components } from "./schema";
import type { Job } from "./types";

type Schemas = components["schemas"];
export type HandModel = Schemas["HandModelOut"];
export type TrainingSet = Schemas["TrainingSetOut"];
export type TrainingRule = Schemas["TrainingRule"];
export type TrainingPreview = Schemas["TrainingPreview"];
export type Lineage = Schemas["Lineage"];
export type LineageItem = Schemas["LineageItem"];
export type LineageKind = LineageItem["kind"];

/** Scans to register; what is left out is as the server has it. */
export interface RegisterWish {
  scan_ids?: readonly string[];
  collection?: string;
  only?: "new" | "not_accepted" | "all";
  model_id?: string;
}

/** How thoroughly a model is judged on people kept for testing. */
export type Evaluate = Schemas["TrainCreate"]["evaluate"];

/** How to train, where it is not as usual. */
export type TrainingWish = Partial<Schemas["TrainingParams"]>;

export interface TrainWish {
  /** Registrations to learn from, or else the rule that chooses them now. */
  training_set_id?: string;
  rule?: TrainingRule;
  name: string;
  model_id?: string;
  options?: TrainingWish;
  evaluate?: Evaluate;
  test_subjects?: readonly string[];
}

/** Register, choose, train, register again. */
export interface LoopWish {
  name: string;
  collection?: string;
  model_id?: string;
  by?: "verdict" | "decisions";
  rounds?: number;
  leave_out_subjects?: readonly string[];
  options?: TrainingWish;
  evaluate?: Evaluate;
}

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

/** Start a job about scans and models; the lists that it changes are loaded again. */
function useStart<Body>(path: string) {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (body: Body) => request<Job>("POST", path, { body }),
    onSuccess: () =>
      Promise.all([jobKeys.all, registrationKeys.all, modelKeys.all].map((queryKey) => client.invalidateQueries({ queryKey }))),
  });
}

export const useStartRegistering = () => useStart<RegisterWish>("/jobs/register");
export const useStartTraining = () => useStart<TrainWish>("/jobs/train");
export const useStartLoop = () => useStart<LoopWish>("/jobs/loop");

export function useHideModel() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: ({ id, isBack }: { id: string; isBack: boolean }) => request(isBack ? "POST" : "DELETE", `/hand-models/${id}${isBack ? "/restore" : ""}`),
    onSuccess: (_, { id, isBack }) => (isBack ? client.invalidateQueries({ queryKey: modelKeys.all }) : refreshAfterDelete(client, modelKeys.all, id)),
  });
}
