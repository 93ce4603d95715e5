import { useQuery } from "@tanstack/react-query";
import { kept, parseKey } from "../model/pose";
import type { PendingSave } from "../state/journal";
import type { Outcome } from "../state/saveQueue";
import { ApiError, request, requestWithHeaders } from "./client";
import { fetchAll } from "./recordings";
import type { Annotation, AnnotationRevision, Page, Side } from "./types";

export const annotationKeys = {
  of: (recording: string) => ["annotations", recording] as const,
  history: (recording: string, key: string) => [...annotationKeys.of(recording), "history", key] as const,
};

/** Of everybody, or of one blind replica. */
export const fetchAnnotations = (recording: string, replica?: string | null): Promise<Annotation[]> =>
  fetchAll<Annotation>(`/sequences/${recording}/annotations`, { limit: 2000, ...(replica ? { replica } : {}) });

export const useAnnotations = (recording: string | undefined) =>
  useQuery({
    queryKey: annotationKeys.of(recording ?? ""),
    queryFn: () => fetchAnnotations(recording ?? ""),
    enabled: Boolean(recording),
  });

const revisionOf = (headers: Headers): number | null => {
  const match = /\d+/.exec(headers.get("ETag") ?? "");
  return match ? Number(match[0]) : null;
};

/** What a failure means for something that waits, where that does not depend on what it is. */
function outcomeOf(failure: unknown): Outcome | null {
  if (!(failure instanceof ApiError) || failure.isOffline) return { kind: "unreachable" };
  if (failure.status >= 500) return { kind: "unreachable", reason: failure.detail };
  return failure.status === 401 ? { kind: "held" } : null;
}

/** One save as the server wants it: on the revision it was made on, repeatable by its operation id. */
export async function sendAnnotation(recording: string, key: string, save: PendingSave, replica?: string): Promise<Outcome> {
  const { camera, frame, hand } = parseKey(key);
  const path = `/sequences/${recording}/annotations/${encodeURIComponent(camera)}/${frame}/${hand}`;
  const headers: Record<string, string> = save.base === null ? { "If-None-Match": "*" } : { "If-Match": `"${save.base}"` };
  try {
    if (save.points === null) {
      if (save.base === null) return { kind: "saved", revision: null };
      const answer = await requestWithHeaders("DELETE", path, { headers, whenOut: "fail", query: { operation_id: save.operationId, replica } });
      return { kind: "saved", revision: null, version: revisionOf(answer.headers) };
    }
    const body = {
      points: save.points.map(([x, y, v]) => [x, y, v]),
      sources: save.points.map(([, , , from]) => from ?? null),
      operation_id: save.operationId,
    };
    const answer = await requestWithHeaders<Annotation>("PUT", path, { body, headers, whenOut: "fail", query: { replica } });
    return { kind: "saved", revision: revisionOf(answer.headers) ?? answer.data.revision };
  } catch (failure) {
    const outcome = outcomeOf(failure);
    if (outcome || !(failure instanceof ApiError)) return outcome ?? { kind: "unreachable" };
    if (failure.status === 409 || failure.status === 412) {
      const theirs = failure.body["theirs"] as Annotation | null | undefined;
      return { kind: "conflict", theirs: { points: theirs ? kept(theirs.points, theirs.sources) : null, revision: theirs?.revision ?? null, author: theirs?.author ?? null } };
    }
    if (failure.status === 404 && save.points === null) return { kind: "saved", revision: null };
    return { kind: "refused", reason: failure.detail };
  }
}

export interface PlaceOf {
  readonly camera: string;
  readonly frame: number;
  readonly hand: Side;
}

/** Hands that people made key frames, of everybody or of one blind replica. */
export const fetchKeyFrames = async (recording: string, replica?: string | null): Promise<PlaceOf[]> =>
  (await request<{ items: PlaceOf[] }>("GET", `/sequences/${recording}/key-frames`, { query: { replica } })).items;

/** A key frame made (points) or taken back (null); twice does no harm. */
export async function sendKeyFrame(recording: string, key: string, { points }: PendingSave, replica?: string): Promise<Outcome> {
  const { camera, frame, hand } = parseKey(key);
  try {
    await request<null>(points ? "PUT" : "DELETE", `/sequences/${recording}/key-frames/${encodeURIComponent(camera)}/${frame}/${hand}`, { whenOut: "fail", query: { replica } });
    return { kind: "saved", revision: null };
  } catch (failure) {
    return outcomeOf(failure) ?? { kind: "refused", reason: (failure as ApiError).detail };
  }
}

/** Every revision of a hand, newest first; empty when nobody ever marked it. */
export const useAnnotationHistory = (recording: string, key: string, savedAt: number | null, replica: string | null) =>
  useQuery({
    queryKey: [...annotationKeys.history(recording, key), savedAt, replica],
    queryFn: async ({ signal }): Promise<AnnotationRevision[]> => {
      const { camera, frame, hand } = parseKey(key);
      return (await request<Page<AnnotationRevision>>("GET", `/sequences/${recording}/annotations/${encodeURIComponent(camera)}/${frame}/${hand}/history`, { signal, query: { replica } })).items;
    },
    placeholderData: (before, query) => (query?.queryKey[3] === key && query.queryKey[5] === replica ? before : undefined),
  });
