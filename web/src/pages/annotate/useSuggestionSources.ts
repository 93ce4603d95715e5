import { useEffect, useEffectEvent, useMemo, useRef, useState } from "react";
import { fetchDetected, fetchFit, fetchTrackSuggestions } from "../../api/suggestions";
import type { Camera } from "../../api/types";
import { keyText, parseKey, placedCount, statusOf } from "../../model/pose";
import type { Source, Suggestion } from "../../model/suggestion";
import { activeKey } from "../../state/annotator";
import { suggest, withdraw } from "../../state/suggestions";
import { useAnnotating } from "./annotating";
import { useAnnotation, useShownCameras } from "./reading";
import { usePatience } from "./usePatience";

/** With fewer joints a model may be anywhere; the server says the same. */
export const MIN_FIT_JOINTS = 4;

const FIT_AFTER_MS = 150;
/** Frames that only fly by are not asked for. */
const REST_MS = 60;

type Ask = (camera: string, frame: number, signal: AbortSignal) => Promise<Suggestion[]>;

/** The cameras whose pictures are shown, the active one first. */
function useAskedCameras(): readonly Camera[] {
  const shown = useShownCameras();
  const active = useAnnotation((state) => state.camera);
  return useMemo(() => [...shown.filter(({ id }) => id === active), ...shown.filter(({ id }) => id !== active)], [shown, active]);
}

/**
 * Keep what a source says of whole images at hand, of all that are shown and of the next ones; the last failure, if that
 * is the answer. All is asked anew when `of` changes: it names what the source goes by.
 */
function useImageSuggestions(source: Source, of: string | undefined, cameras: readonly Camera[], fetch: Ask): string | null {
  // What is asked changes with `of` alone.
  const fetchNow = useEffectEvent(fetch);
  const { suggestions } = useAnnotating().session;
  const [frame, frameCount] = [useAnnotation((state) => state.frame), useAnnotation((state) => state.frameCount)];
  const asked = useRef(new Set<string>());
  const [failure, setFailure] = useState<string | null>(null);
  const { round, failed, succeeded } = usePatience();

  useEffect(() => {
    asked.current.clear();
    withdraw(suggestions, source);
  }, [suggestions, source, of]);

  useEffect(() => {
    if (cameras.length === 0) return;
    const call = new AbortController();
    const images = [frame, frame + 1].filter((one) => one < frameCount).flatMap((one) => cameras.map(({ id }) => [id, one] as const));
    const ask = async (): Promise<void> => {
      for (const [camera, one] of images) {
        const name = `${one}|${camera}`;
        if (asked.current.has(name)) continue;
        asked.current.add(name);
        try {
          const found = await fetchNow(camera, one, call.signal);
          if (!call.signal.aborted) suggest(suggestions, found);
          if (!call.signal.aborted) setFailure(null);
          succeeded();
        } catch (reason) {
          // Without it there is less to accept and nothing else; what may come later is asked for again, as on the next visit.
          asked.current.delete(name);
          if (!call.signal.aborted) {
            setFailure((reason as Error).message);
            failed(reason as Error);
          }
          return;
        }
        if (call.signal.aborted) asked.current.delete(name);
      }
    };
    const timer = setTimeout(() => void ask(), REST_MS);
    return () => {
      clearTimeout(timer);
      call.abort();
    };
  }, [suggestions, cameras, frame, frameCount, of, round, failed, succeeded]);

  return cameras.length > 0 ? failure : null;
}

/** The track's hands. */
export function useTrackSuggestions(track: string | undefined): void {
  const recording = useAnnotating().recording.get().id;
  useImageSuggestions("track", track, useAskedCameras(), (camera, frame, signal) => fetchTrackSuggestions(recording, camera, frame, track, signal));
}

/** The hands that the detector sees; `job` is the one that looked through the whole recording, if one did. */
export function useDetectedSuggestions(job: string | undefined, isWanted: boolean): string | null {
  const recording = useAnnotating().recording.get().id;
  const asked = useAskedCameras();
  const cameras = useMemo(() => (isWanted ? asked.filter((camera) => camera.has_color) : []), [asked, isWanted]);
  return useImageSuggestions("detector", job, cameras, (camera, frame, signal) => fetchDetected(recording, camera, frame, signal));
}

/** Fit a model to the joints placed so far, a moment after each; an answer that is older than the joints is dropped. */
export function useFitSuggestion(isWanted: boolean): string | null {
  const { recording, session } = useAnnotating();
  const { suggestions } = session;
  const { id } = recording.get();
  const [failure, setFailure] = useState<string | null>(null);
  const key = useAnnotation((state) => keyText(activeKey(state)));
  const pose = useAnnotation((state) => state.poses[key]);
  const { round, failed, succeeded } = usePatience();

  useEffect(() => {
    const place = parseKey(key);
    setFailure(null);
    if (!pose || placedCount(pose) < MIN_FIT_JOINTS) return withdraw(suggestions, "fit", place);
    if (!isWanted || pose.every((point) => statusOf(point) !== "unset")) return;
    const call = new AbortController();
    const timer = setTimeout(() => {
      fetchFit(id, place, pose, call.signal).then(
        (found) => {
          if (call.signal.aborted) return;
          suggest(suggestions, [found]);
          succeeded();
        },
        (reason: Error) => {
          if (call.signal.aborted) return;
          setFailure(reason.message);
          failed(reason);
        },
      );
    }, FIT_AFTER_MS);
    return () => {
      clearTimeout(timer);
      call.abort();
    };
  }, [id, suggestions, key, pose, isWanted, round, failed, succeeded]);

  return failure;
}
