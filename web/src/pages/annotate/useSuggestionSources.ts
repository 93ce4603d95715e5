import { useEffect, useRef, useState } from "react";
import { fetchFit, fetchTrackSuggestions } from "../../api/suggestions";
import { keyText, placedCount, statusOf } from "../../model/pose";
import { activeKey } from "../../state/annotator";
import { suggest, withdraw } from "../../state/suggestions";
import { useAnnotating } from "./annotating";

/** With fewer joints a model may be anywhere; the server says the same. */
export const MIN_FIT_JOINTS = 4;

const FIT_AFTER_MS = 150;
/** Frames that only fly by are not asked for. */
const REST_MS = 60;

/** Keep the track's hands of this image and of the next one at hand. */
export function useTrackSuggestions(track: string | undefined, isWanted: boolean): void {
  const { recording, session, state } = useAnnotating();
  const { suggestions } = session;
  const asked = useRef(new Set<string>());

  useEffect(() => {
    asked.current.clear();
    withdraw(suggestions, "track");
  }, [suggestions, track]);

  useEffect(() => {
    if (!isWanted) return;
    const call = new AbortController();
    const ask = async (): Promise<void> => {
      for (const frame of [state.frame, state.frame + 1]) {
        const name = `${frame}|${state.camera}`;
        if (frame >= state.frameCount || asked.current.has(name)) continue;
        asked.current.add(name);
        try {
          const found = await fetchTrackSuggestions(recording.id, state.camera, frame, track, call.signal);
          if (!call.signal.aborted) suggest(suggestions, found);
        } catch {
          // Without it there is less to accept and nothing else; the next visit asks again.
        }
        if (call.signal.aborted) asked.current.delete(name);
      }
    };
    const timer = setTimeout(() => void ask(), REST_MS);
    return () => {
      clearTimeout(timer);
      call.abort();
    };
  }, [recording.id, suggestions, state.camera, state.frame, state.frameCount, track, isWanted]);
}

/** Fit a model to the joints placed so far, a moment after each; an answer that is older than the joints is dropped. */
export function useFitSuggestion(isWanted: boolean): string | null {
  const { recording, session, state } = useAnnotating();
  const { suggestions } = session;
  const [failure, setFailure] = useState<string | null>(null);
  const key = keyText(activeKey(state));
  const pose = state.poses[key];

  useEffect(() => {
    const place = { camera: state.camera, frame: state.frame, hand: state.hand };
    setFailure(null);
    if (!pose || placedCount(pose) < MIN_FIT_JOINTS) return withdraw(suggestions, "fit", place);
    if (!isWanted || pose.every((point) => statusOf(point) !== "unset")) return;
    const call = new AbortController();
    const timer = setTimeout(() => {
      fetchFit(recording.id, place, pose, call.signal).then(
        (found) => !call.signal.aborted && suggest(suggestions, [found]),
        (reason: Error) => !call.signal.aborted && setFailure(reason.message),
      );
    }, FIT_AFTER_MS);
    return () => {
      clearTimeout(timer);
      call.abort();
    };
    // The key says camera, frame and hand.
    // eslint-disable-next-line react-hooks/exhaustive-deps
  }, [recording.id, suggestions, key, pose, isWanted]);

  return failure;
}
