/** The body with hands: posed by the server, exported, and motions of it read. */

import { keepPreviousData, useMutation, useQuery, type QueryClient } from "@tanstack/react-query";
import { API, fetchBytes, request, saveAnswer, sendForBytes, upload } from "./client";
import { readGeometry } from "./geometryFile";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type BodyModel = Schemas["BodyModelOut"];
export type BodyMotion = Schemas["BodyMotionOut"];
export type Population = BodyModel["population"];
export type BodyFrame = Schemas["BodyFrame"];
export type BodyFormat = Schemas["BodyExport"]["format"];

export const POPULATIONS: readonly Population[] = ["neutral", "female", "male"];
/** Frames of a motion that are posed by one request. */
export const BLOCK = 32;
/** Vertices of poses are kept so long after they were last shown, ms. */
const KEPT_MS = 30_000;

const bodyKey = (population: Population) => ["body-models", population] as const;

export const useBody = (population: Population) =>
  useQuery({ queryKey: bodyKey(population), queryFn: () => request<BodyModel>("GET", `/body-models/${population}`), staleTime: Infinity, placeholderData: keepPreviousData });

/** Corners of the body's triangles; the same for every population. */
export const useBodyFaces = () =>
  useQuery({
    queryKey: ["body-models", "faces"],
    queryFn: async () => readGeometry((await fetchBytes(`${API}/body-models/neutral/geometry`)).data).arrays["faces"] as Uint32Array,
    staleTime: Infinity,
  });

async function fetchPoses(population: Population, shape: readonly number[], frames: readonly BodyFrame[], signal: AbortSignal): Promise<Float32Array> {
  const data = await sendForBytes("POST", `/body-models/${population}/poses`, { body: { shape, frames }, signal });
  return readGeometry(data).arrays["vertices"] as Float32Array;
}

/** Vertices of one pose; those of the pose before until they are there. */
export const useBodyPose = (population: Population, shape: readonly number[], frame: BodyFrame) =>
  useQuery({
    queryKey: [...bodyKey(population), "pose", shape, frame],
    queryFn: ({ signal }) => fetchPoses(population, shape, [frame], signal),
    staleTime: Infinity,
    gcTime: KEPT_MS,
    placeholderData: keepPreviousData,
  });

export const frameOf = ({ poses, translations }: BodyMotion, at: number): BodyFrame => ({
  pose: poses[at] ?? null,
  joints: {},
  hands: {},
  translation: translations[at] ?? [0, 0, 0],
});

const framesOf = (motion: BodyMotion, from: number, to: number): BodyFrame[] =>
  Array.from({ length: Math.max(0, Math.min(to, motion.poses.length) - from) }, (_, at) => frameOf(motion, from + at));

/** Vertices of the frames of one block of a motion. `motionId` tells motions apart. */
const blockQuery = (population: Population, motion: BodyMotion, motionId: string, block: number) => ({
  queryKey: [...bodyKey(population), "motion", motionId, block],
  queryFn: ({ signal }: { signal: AbortSignal }) => fetchPoses(population, motion.shape, framesOf(motion, block * BLOCK, (block + 1) * BLOCK), signal),
  staleTime: Infinity,
  gcTime: KEPT_MS,
});

export const fetchBlock = (client: QueryClient, population: Population, motion: BodyMotion, motionId: string, block: number): Promise<Float32Array> =>
  client.fetchQuery(blockQuery(population, motion, motionId, block));

/** What of a motion is there already; undefined when the block must be fetched. */
export const peekBlock = (client: QueryClient, population: Population, motionId: string, block: number): Float32Array | undefined =>
  client.getQueryData<Float32Array>([...bodyKey(population), "motion", motionId, block]);

export const useReadMotion = () =>
  useMutation({
    mutationFn: (file: File) => {
      const form = new FormData();
      form.append("files", file, file.name);
      return upload<BodyMotion>("/body-models/motions", form, () => undefined, new AbortController().signal);
    },
  });

export interface BodyExportWish {
  population: Population;
  format: BodyFormat;
  shape: readonly number[];
  frames: readonly BodyFrame[];
  fps: number;
}

/** Poses as a file that the browser saves. */
export const useExportBody = () =>
  useMutation({
    mutationFn: async ({ population, ...body }: BodyExportWish) =>
      saveAnswer(await sendForBytes("POST", `/body-models/${population}/export`, { body }), `${population}_body.${body.format}`),
  });

export const smplhFileUrl = (population: Population, kind: "npz" | "pkl"): string => `${API}/body-models/${population}/smplh.${kind}`;

export const allFrames = (motion: BodyMotion): BodyFrame[] => framesOf(motion, 0, motion.poses.length);
