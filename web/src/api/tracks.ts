import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { API, ApiError, request } from "./client";
import { fetchAll } from "./recordings";
import type { Evaluation, Track, TrackFrames, TrackJoints, ViewerSession } from "./types";

export const trackKeys = {
  all: ["tracks"] as const,
  one: (id: string) => ["tracks", id] as const,
};

export const useTracks = (recording?: string) =>
  useQuery({
    queryKey: [...trackKeys.all, "list", recording ?? null],
    queryFn: () => fetchAll<Track>("/tracks", { sequence_id: recording }),
  });

export const useTrack = (id: string) =>
  useQuery({ queryKey: trackKeys.one(id), queryFn: () => request<Track>("GET", `/tracks/${id}`), retry: false });

export const useTrackFrames = (id: string | undefined) =>
  useQuery({
    queryKey: [...trackKeys.one(id ?? ""), "frames"],
    queryFn: () => request<TrackFrames>("GET", `/tracks/${id}/frames`),
    enabled: Boolean(id),
    staleTime: Infinity,
  });

export const useTrackJoints = (id: string, camera: string | undefined) =>
  useQuery({
    queryKey: [...trackKeys.one(id), "joints", camera],
    queryFn: () => request<TrackJoints>("GET", `/tracks/${id}/joints`, { query: { camera } }),
    enabled: Boolean(camera),
    staleTime: Infinity,
  });

/** Error in the image against the annotations of now; null when there is nothing to compare with. */
export const useEvaluation = (id: string) =>
  useQuery({
    queryKey: [...trackKeys.one(id), "evaluation"],
    queryFn: async () => {
      try {
        return await request<Evaluation>("GET", `/tracks/${id}/evaluation`);
      } catch (failure) {
        if (failure instanceof ApiError && failure.status >= 400 && failure.status < 500) return null;
        throw failure;
      }
    },
  });

export const overlayUrl = (track: string, camera: string, frame: number): string =>
  `${API}/tracks/${track}/cameras/${encodeURIComponent(camera)}/frames/${frame}/overlay.png`;

export const trackFileUrl = (track: string, name: string): string => `${API}/tracks/${track}/files/${name}`;

/** What a track can be exported as. */
export const EXPORTS = [
  { kind: "npz", label: "Arrays (npz)", isOfHands: false },
  { kind: "csv", label: "Table of joints (CSV)", isOfHands: false },
  { kind: "glb", label: "Animation (glTF)", isOfHands: false },
  { kind: "mano", label: "MANO-style parameters (npz)", isOfHands: true },
] as const;

export const exportUrl = (track: string, kind: (typeof EXPORTS)[number]["kind"]): string => `${API}/tracks/${track}/export/${kind}`;

export function useDeleteTrack() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request("DELETE", `/tracks/${id}`),
    onSuccess: () => client.invalidateQueries({ queryKey: trackKeys.all }),
  });
}

export function useRestoreTrack() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => request("POST", `/tracks/${id}/restore`),
    onSuccess: () => client.invalidateQueries({ queryKey: trackKeys.all }),
  });
}

/** Layers of the 3D viewer, under the viewer's own names. */
export interface Shown {
  cloud: boolean;
  mesh: boolean;
  skeleton: boolean;
  correspondences: boolean;
  dark: boolean;
}

interface Viewer {
  session: ViewerSession | null;
  terms: ViewerSession["terms"];
  failure: Error | null;
  retry: () => void;
}

/** A viewer session of this page: made with it, told of frame and toggles (the newest only), ended with it. */
export function useViewer(track: string, frame: number, show: Shown): Viewer {
  const [session, setSession] = useState<ViewerSession | null>(null);
  const [terms, setTerms] = useState<ViewerSession["terms"]>([]);
  const [failure, setFailure] = useState<Error | null>(null);
  const [attempt, setAttempt] = useState(0);
  const wanted = useRef({ frame, show });
  const isTelling = useRef(false);
  wanted.current = { frame, show };

  useEffect(() => {
    let made: ViewerSession | null = null;
    let isGone = false;
    const end = (id: string): void => void request("DELETE", `/viewer-sessions/${id}`, { keepalive: true }).catch(() => undefined);
    setSession(null);
    setFailure(null);
    request<ViewerSession>("POST", "/viewer-sessions", { body: { track_id: track, ...wanted.current } }).then(
      (opened) => {
        made = opened;
        if (isGone) end(opened.id);
        else setSession(opened);
      },
      (reason: Error) => !isGone && setFailure(reason),
    );
    const leave = (): void => {
      if (made) end(made.id);
    };
    window.addEventListener("pagehide", leave);
    return () => {
      isGone = true;
      window.removeEventListener("pagehide", leave);
      leave();
    };
  }, [track, attempt]);

  useEffect(() => {
    if (!session || isTelling.current) return;
    isTelling.current = true;
    const tell = async (): Promise<void> => {
      let told: typeof wanted.current | null = null;
      while (told?.frame !== wanted.current.frame || told.show !== wanted.current.show) {
        told = wanted.current;
        const now = await request<ViewerSession>("PUT", `/viewer-sessions/${session.id}`, { body: told });
        setTerms(now.terms);
      }
    };
    tell()
      .catch((reason: Error) => setFailure(reason))
      .finally(() => {
        isTelling.current = false;
      });
  }, [session, frame, show]);

  return { session, terms, failure, retry: () => setAttempt((count) => count + 1) };
}
