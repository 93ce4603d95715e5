import { keepPreviousData, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { refreshAfterDelete } from "./afterDelete";
import { API, ApiError, request } from "./client";
import { fetchAll } from "./recordings";
import type { Evaluation, FrameEnergy, Track, TrackFrames, TrackJoints, ViewerSession } from "./types";

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
  useQuery({ queryKey: trackKeys.one(id), queryFn: () => request<Track>("GET", `/tracks/${id}`), retry: false, enabled: id !== "" });

export const useTrackFrames = (id: string | undefined) =>
  useQuery({
    queryKey: [...trackKeys.one(id ?? ""), "frames"],
    queryFn: () => request<TrackFrames>("GET", `/tracks/${id}/frames`),
    enabled: Boolean(id),
    staleTime: Infinity,
  });

/** Energy of one frame by term and iteration; the last one stays until the next is there. */
export const useFrameEnergy = (id: string, frame: number) =>
  useQuery({
    queryKey: [...trackKeys.one(id), "energy", frame],
    queryFn: () => request<FrameEnergy>("GET", `/tracks/${id}/frames/${frame}/energy`),
    staleTime: Infinity,
    placeholderData: keepPreviousData,
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
    enabled: id !== "",
  });

/** Mean error of a track in px; null when it was compared with nothing. Every page that shows it asks here. */
export const errorOf = (evaluation: Evaluation | null | undefined): number | null =>
  evaluation && evaluation.evaluated > 0 ? (evaluation.joint_error_px.mean ?? null) : null;

export const overlayUrl = (track: string, camera: string, frame: number): string =>
  `${API}/tracks/${track}/cameras/${encodeURIComponent(camera)}/frames/${frame}/overlay.png`;

/** What the run left out as neither hand nor a model. */
export const unknownUrl = (track: string, camera: string, frame: number): string =>
  `${API}/tracks/${track}/cameras/${encodeURIComponent(camera)}/frames/${frame}/unknown.png`;

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
    onSuccess: (_, id) => refreshAfterDelete(client, trackKeys.all, id),
  });
}

/** Layers of the 3D viewer that are on or off. */
export const LAYERS = ["cloud", "mesh", "skeleton", "correspondences", "detections", "collisions", "contacts", "unknown", "distances", "cameras"] as const;
export type Layer = (typeof LAYERS)[number];

/** What the 3D viewer is to show, under its own names. */
export type Shown = Record<Exclude<Layer, "correspondences">, boolean> & {
  /** Terms that are hidden are false; terms that are not named are shown. */
  correspondences: boolean | Record<string, boolean>;
  dark: boolean;
};

export interface Viewer {
  session: ViewerSession | null;
  /** What the server said of the frame that is shown. */
  told: ViewerSession | null;
  /** The server is at work on another frame or other layers. */
  isBusy: boolean;
  failure: Error | null;
  retry: () => void;
}

/** A viewer session of this page: made with it, told of frame and toggles (the newest only), ended with it. */
export function useViewer(track: string, frame: number, show: Shown): Viewer {
  const [session, setSession] = useState<ViewerSession | null>(null);
  const [told, setTold] = useState<ViewerSession | null>(null);
  const [isBusy, setBusy] = useState(false);
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
    setTold(null);
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
    setBusy(true);
    const tell = async (): Promise<void> => {
      let sent: typeof wanted.current | null = null;
      while (sent?.frame !== wanted.current.frame || sent.show !== wanted.current.show) {
        sent = wanted.current;
        setTold(await request<ViewerSession>("PUT", `/viewer-sessions/${session.id}`, { body: sent }));
      }
    };
    tell()
      .catch((reason: Error) => setFailure(reason))
      .finally(() => {
        isTelling.current = false;
        setBusy(false);
      });
  }, [session, frame, show]);

  return { session, told, isBusy, failure, retry: () => setAttempt((count) => count + 1) };
}
