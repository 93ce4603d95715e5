import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useState, useSyncExternalStore } from "react";
import { notifications } from "@mantine/notifications";
import { annotationKeys, fetchAnnotations, fetchKeyFrames } from "../../api/annotations";
import { ApiError } from "../../api/client";
import { recordingKeys } from "../../api/recordings";
import type { Recording } from "../../api/types";
import type { AnnotatorState } from "../../state/annotator";
import { useMe } from "../../state/me";
import { keyQueueOf, queueOf, scopeOf } from "../../state/saving";
import type { SaveStatus } from "../../state/saveQueue";
import { createKeyFrames, type KeyFrames } from "../../state/keyFrames";
import { keyText } from "../../model/pose";
import type { SuggestionsState } from "../../state/suggestions";
import { openSession, revisionsOf, type Session, type Start } from "../../state/session";
import { openLive } from "./openLive";

interface Opened {
  session: Session | null;
  failure: Error | null;
  retry: () => void;
}

/** Open a recording's annotations, as the server has them now with what still waits here on top. */
export function useSession(recording: Recording | undefined, start: () => Start, replica: string | null = null): Opened {
  const [session, setSession] = useState<Session | null>(null);
  const [failure, setFailure] = useState<Error | null>(null);
  const [attempt, setAttempt] = useState(0);
  const client = useQueryClient();
  const me = useMe();
  const id = recording?.id;

  useEffect(() => {
    if (!recording) return;
    let isGone = false;
    let close = (): void => undefined;
    const scope = scopeOf(recording.id, replica);
    const queue = queueOf(scope);
    const open = async (): Promise<void> => {
      for (let tries = 0; tries < 3; tries += 1) {
        const [annotations, keys] = await Promise.all([fetchAnnotations(recording.id, replica), fetchKeyFrames(recording.id, replica)]);
        if (isGone) return;
        // A save of an earlier visit may arrive while we load: then load again.
        if (!queue.learn(revisionsOf(annotations), tries === 2)) continue;
        const keyFrames = createKeyFrames(keys.map(keyText), keyQueueOf(scope), (message) =>
          notifications.show({ color: "red", title: "The key frame was not kept", message }),
        );
        keyFrames.queue.flush();
        const opened = openSession(recording, annotations, queue, start(), keyFrames);
        const leave = openLive({ recording, replica, session: opened, me, annotations, client });
        close = () => {
          leave();
          opened.close();
        };
        setSession(opened);
        return;
      }
    };
    open().then(
      () => !isGone && setFailure(null),
      (reason: Error) => !isGone && setFailure(reason),
    );
    return () => {
      isGone = true;
      close();
      setSession(null);
      void client.invalidateQueries({ queryKey: annotationKeys.of(recording.id) });
      void client.invalidateQueries({ queryKey: recordingKeys.all });
    };
    // Only another recording or replica, or another try, opens another session.
    // eslint-disable-next-line react-hooks/exhaustive-deps
  }, [id, replica, attempt]);

  useEffect(() => {
    // A server that is only away for a moment needs nobody to press a button.
    if (!(failure instanceof ApiError && failure.isOffline)) return;
    const timer = setTimeout(() => setAttempt((count) => count + 1), 3000);
    return () => clearTimeout(timer);
  }, [failure]);

  return { session, failure, retry: useCallback(() => setAttempt((count) => count + 1), []) };
}

export const useAnnotatorState = (session: Session): AnnotatorState =>
  useSyncExternalStore(useCallback((tell) => session.store.watch(tell), [session]), session.store.get);

export const useSaveStatus = (session: Session): SaveStatus =>
  useSyncExternalStore(session.watchSaving, session.saving);

export const useSuggestions = (session: Session): SuggestionsState =>
  useSyncExternalStore(useCallback((tell) => session.suggestions.watch(tell), [session]), session.suggestions.get);

export const useKeyFrames = (session: Session): KeyFrames =>
  useSyncExternalStore(useCallback((tell) => session.keyFrames.store.watch(tell), [session]), session.keyFrames.store.get);
