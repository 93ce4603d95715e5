import { request } from "./client";
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Triangulation = Schemas["TriangulationOut"];
export type TriangulatedJoint = Schemas["TriangulatedJoint"];
export type TriangulatedView = Schemas["TriangulatedView"];
export type MarkedView = Schemas["TriangulationView"];

export const fetchTriangulation = (recording: string, views: readonly MarkedView[], signal?: AbortSignal): Promise<Triangulation> =>
  request("POST", `/sequences/${recording}/triangulation`, { body: { views }, ...(signal ? { signal } : {}) });
