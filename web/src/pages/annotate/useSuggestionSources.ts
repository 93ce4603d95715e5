import { useEffect, useRef, useState } from "react";
import { fetchDetected, fetchFit, fetchTrackSuggestions } from "../../api/suggestions";
import { keyText, placedCount, statusOf } from "../../model/pose";
import type { Source, Suggestion } from "../../model/suggestion";
import { activeKey } from "../../state/annotator";
import { suggest, withdraw } from "../../state/suggestions";
import { useAnnotating } from "./annotating";
import { usePatience } from "./usePatience";

/** With fewer joints a model may be anywhere; the server says the same. */
export const MIN_FIT_JOINTS = 4;

const FIT_AFTER_MS = 150;
/** Frames that only fly by are not asked for. */
const REST_MS = 60;

type Ask = (camera: string, frame: number, signal: AbortSignal) => Promise<Suggestion[]>;

/**
 * Keep what a source says of whole images at hand, of this one and of the next; the last failure, if that is the answer.
 * All is asked anew when `of` changes: it names what the source goes by.
 */
function useImageSuggestions(source: Source, of: string | undefined, isWanted: boolean, fetch: Ask): string | null {
  const { session, state } = useAnnotating();
  const { suggestions } = session;
  const asked = useRef(new Set<string>());
  const [failure, setFailure] = useState<string | null>(null);
  const patience = usePatience();

  useEffect(() => {
    asked.current.clear();
    withdraw(suggestions, source);
  }, [suggestions, source, of]);

  useEffect(() => {
    if (!isWanted) return;
    const call = new AbortController();
    const ask = async (): Promise<void> => {
      for (const frame of [state.frame, state.frame + 1]) {
        const name = `${frame}|${state.camera}`;
        if (frame >= state.frameCount || asked.current.has(name)) continue;
        asked.current.add(name);
        try {
          const found = await fetch(state.camera, frame, call.signal);
          if (!call.signal.aborted) suggest(suggestions, found);
          if (!call.signal.aborted) setFailure(null);
          patience.succeeded();
        } catch (reason) {
          // Without it there is less to accept and nothing else; what may come later is asked for again, as on the next visit.
          asked.current.delete(name);
          if (!call.signal.aborted) {
            setFailure((reason as Error).message);
            patience.failed(reason as Error);
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
    // What is asked changes with `of` alone.
    // eslint-disable-next-line react-hooks/exhaustive-deps
  }, [suggestions, state.camera, state.frame, state.frameCount, of, isWanted, patience.round]);

  return isWanted ? failure : null;
}

/** The track's hands. */
export function useTrackSuggestions(track: string | undefined, isWanted: boolean): void {
  const recording = useAnnotating().recording.id;
  useImageSuggestions("track", track, isWanted, (camera, frame, signal) => fetchTrackSuggestions(recording, camera, frame, track, signal));
}

/** The hands that the detector sees; `job` is the one that looked through the whole recording, if one did. */
export function useDetectedSuggestions(job: string | undefined, isWanted: boolean): string | null {
  const recording = useAnnotating().recording.id;
  return useImageSuggestions("detector", job, isWanted, (camera, frame, signal) => fetchDetected(recording, camera, frame, signal));
}

/** Fit a model to the joints placed so far, a moment after each; an answer that is older than the joints is dropped. */
export function useFitSuggestion(isWanted: boolean): string | null {
  const { recording, session, state } = useAnnotating();
  const { suggestions } = session;
  const [failure, setFailure] = useState<string | null>(null);
  const key = keyText(activeKey(state));
  const pose = state.poses[key];
  const patience = usePatience();

  useEffect(() => {
    const place = { camera: state.camera, frame: state.frame, hand: state.hand };
    setFailure(null);
    if (!pose || placedCount(pose) < MIN_FIT_JOINTS) return withdraw(suggestions, "fit", place);
    if (!isWanted || pose.every((point) => statusOf(point) !== "unset")) return;
    const call = new AbortController();
    const timer = setTimeout(() => {
      fetchFit(recording.id, place, pose, call.signal).then(
        (found) => {
          if (call.signal.aborted) return;
          suggest(suggestions, [found]);
          patience.succeeded();
        },
        (reason: Error) => {
          if (call.signal.aborted) return;
          setFailure(reason.message);
          patience.failed(reason);
        },
      );
    }, FIT_AFTER_MS);
    return () => {
      clearTimeout(timer);
      call.abort();
    };
    // The key says camera, frame and hand.
    // eslint-disable-next-line react-hooks/exhaustive-deps
  }, [recording.id, suggestions, key, pose, isWanted, patience.round]);

  return failure;
}
