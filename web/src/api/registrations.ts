/** Registrations: the template brought onto a scan; who decides about them; how people agree. */

import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { HandGeometry } from "../canvas/hand3d/geometry";
import { uprightFrom, type Pattern } from "../model/upright";
import type { DecisionOutcome, LoggedDecision } from "../state/decisionLog";
import { API, ApiError, fetchBytes, request } from "./client";
import { readGeometry } from "./geometryFile";
import { fetchScanGeometry, POINTS } from "./scans";
import type { components } from "./schema";
import type { Page } from "./types";

type Schemas = components["schemas"];
export type Registration = Schemas["RegistrationOut"];
export type RegistrationCounts = Schemas["RegistrationCounts"];
export type Verdict = Registration["verdict"];
export type Reason = Schemas["ReasonOut"];
export type Decision = Schemas["DecisionOut"];
export type ReviewAgreement = Schemas["ReviewAgreement"];
export type Queue = "undecided" | "all" | "flagged" | "second";
export type Order = "likely_failures" | "newest";

/** Which registrations a queue holds. */
export interface QueueChoice {
  readonly queue: Queue;
  readonly order: Order;
  readonly collection?: string | undefined;
  readonly model_id?: string | undefined;
  readonly decision?: string | undefined;
}

export const registrationKeys = { all: ["registrations"] as const };

const PAGE = 50;

export const fetchQueue = (choice: QueueChoice, cursor: string | null): Promise<Page<Registration>> =>
  request("GET", "/registrations", { query: { ...choice, cursor, limit: PAGE } });

export const useQueueCounts = ({ collection, model_id }: Pick<QueueChoice, "collection" | "model_id">) =>
  useQuery({
    queryKey: [...registrationKeys.all, "counts", collection, model_id],
    queryFn: () => request<RegistrationCounts>("GET", "/registrations/counts", { query: { collection, model_id } }),
  });

export const useRegistration = (id: string | null) =>
  useQuery({
    queryKey: [...registrationKeys.all, "one", id],
    queryFn: () => request<Registration>("GET", `/registrations/${id}`),
    enabled: id !== null,
  });

/** Every registration of a scan, the newest first. */
export const useScanRegistrations = (scan: string) =>
  useQuery({
    queryKey: [...registrationKeys.all, "scan", scan],
    queryFn: async () => (await request<Page<Registration>>("GET", "/registrations", { query: { scan_id: scan } })).items,
  });

export const useReasons = () =>
  useQuery({
    queryKey: ["curation", "reasons"],
    queryFn: async () => (await request<Page<Reason>>("GET", "/curation/reasons")).items,
    staleTime: Infinity,
  });

export const useDecisions = (registration: string | null) =>
  useQuery({
    queryKey: [...registrationKeys.all, "decisions", registration],
    queryFn: async () => (await request<Page<Decision>>("GET", `/registrations/${registration}/decisions`)).items,
    enabled: registration !== null,
  });

export const useThroughput = () =>
  useQuery({ queryKey: ["curation", "throughput"], queryFn: () => request<Schemas["Throughput"]>("GET", "/curation/throughput"), refetchInterval: 60_000 });

export const useReviewAgreement = (collection: string | undefined) =>
  useQuery({
    queryKey: ["curation", "agreement", collection],
    queryFn: () => request<ReviewAgreement>("GET", "/curation/agreement", { query: { collection } }),
  });

export function useAskSecondReview() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (body: Schemas["SecondReviewAsk"]) => request<Schemas["SecondReviewAsked"]>("POST", "/curation/second-reviews", { body }),
    onSuccess: () =>
      Promise.all([client.invalidateQueries({ queryKey: registrationKeys.all }), client.invalidateQueries({ queryKey: ["curation", "agreement"] })]),
  });
}

/** One entry of the decision log as the server wants it, repeatable by its operation id. */
export async function sendDecision(logged: LoggedDecision): Promise<DecisionOutcome> {
  const body = { operation_id: logged.operationId };
  try {
    if (logged.decision === "undo") {
      const decisionId = logged.undoes && "decisionId" in logged.undoes ? logged.undoes.decisionId : null;
      if (decisionId === null) return { kind: "refused", reason: "What it takes back never reached the server." };
      const done = await request<Schemas["DecisionDone"]>("POST", `/decisions/${decisionId}/undo`, { body, whenOut: "fail" });
      return { kind: "saved", decisionId: done.decision.id };
    }
    const { decision, reasons, seconds } = logged;
    const done = await request<Schemas["DecisionDone"]>("POST", `/registrations/${logged.registrationId}/decisions`, {
      body: { ...body, decision, reasons, seconds },
      whenOut: "fail",
    });
    return { kind: "saved", decisionId: done.decision.id };
  } catch (failure) {
    if (!(failure instanceof ApiError) || failure.isOffline) return { kind: "unreachable" };
    if (failure.status >= 500 || failure.status === 429) return { kind: "unreachable", reason: failure.detail };
    if (failure.status === 401) return { kind: "held" };
    return { kind: "refused", reason: failure.detail };
  }
}

/** What nothing was compared with comes as not-a-number and goes to the 3D view as -1. */
const knownErrors = (errors: Float32Array): Float32Array => errors.map((error) => (Number.isNaN(error) ? -1 : error));

/** Scan and mesh of a registration, with the distances between them; `pattern` says which way up. */
export async function fetchRegistrationGeometry(registration: Registration, pattern: Pattern | null, signal?: AbortSignal): Promise<HandGeometry> {
  const [scanned, { data }] = await Promise.all([
    fetchScanGeometry(registration.scan, registration.side, signal),
    fetchBytes(`${API}/registrations/${registration.id}/geometry?size=${POINTS}`, signal),
  ]);
  const { arrays } = readGeometry(data);
  const positions = arrays["vertices"] as Float32Array;
  return {
    ...scanned,
    scan: { ...scanned.scan, errorMm: knownErrors(arrays["point_error_mm"] as Float32Array) },
    mesh: { positions, normals: null, colors: null, index: arrays["faces"] as Uint32Array, errorMm: knownErrors(arrays["vertex_error_mm"] as Float32Array), taken: null },
    upright: pattern && pattern.vertices.length === positions.length ? uprightFrom(positions, pattern, registration.side) : scanned.upright,
  };
}
