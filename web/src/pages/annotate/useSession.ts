import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useEffectEvent, useState } from "react";
import { notifications } from "@mantine/notifications";
import { annotationKeys, fetchAnnotations, fetchKeyFrames } from "../../api/annotations";
import { ApiError } from "../../api/client";
import { recordingKeys } from "../../api/recordings";
import type { Recording } from "../../api/types";
import { useMe } from "../../state/me";
import { keyQueueOf, queueOf, scopeOf } from "../../state/saving";
import { createKeyFrames } from "../../state/keyFrames";
import { keyText } from "../../model/pose";
import { openSession, revisionsOf, type Session, type Start } from "../../state/session";
import { openLive } from "./openLive";

/** A session that is being opened, until its page is left. */
interface Opening {
  isGone: boolean;
  close: () => void;
}

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

  const open = useEffectEvent(async (opening: Opening): Promise<void> => {
    if (!recording) return;
    const scope = scopeOf(recording.id, replica);
    const queue = queueOf(scope);
    for (let tries = 0; tries < 3; tries += 1) {
      const [annotations, keys] = await Promise.all([fetchAnnotations(recording.id, replica), fetchKeyFrames(recording.id, replica)]);
      if (opening.isGone) return;
      // A save of an earlier visit may arrive while we load: then load again.
      if (!queue.learn(revisionsOf(annotations), tries === 2)) continue;
      const keyFrames = createKeyFrames(keys.map(keyText), keyQueueOf(scope), (message) =>
        notifications.show({ color: "red", title: "The key frame was not kept", message }),
      );
      keyFrames.queue.flush();
      const opened = openSession(recording, annotations, queue, start(), keyFrames);
      const leave = openLive({ recording, replica, session: opened, me, annotations, client });
      opening.close = () => {
        leave();
        opened.close();
      };
      setSession(opened);
      return;
    }
  });

  // Only another recording or replica, or another try, opens another session.
  useEffect(() => {
    if (id === undefined) return;
    const opening: Opening = { isGone: false, close: () => undefined };
    open(opening).then(
      () => !opening.isGone && setFailure(null),
      (reason: Error) => !opening.isGone && setFailure(reason),
    );
    return () => {
      opening.isGone = true;
      opening.close();
      setSession(null);
      void client.invalidateQueries({ queryKey: annotationKeys.of(id) });
      void client.invalidateQueries({ queryKey: recordingKeys.all });
    };
  }, [client, id, replica, attempt]);

  useEffect(() => {
    // A server that is only away for a moment needs nobody to press a button.
    if (!(failure instanceof ApiError && failure.isOffline)) return;
    const timer = setTimeout(() => setAttempt((count) => count + 1), 3000);
    return () => clearTimeout(timer);
  }, [failure]);

  return { session, failure, retry: useCallback(() => setAttempt((count) => count + 1), []) };
}
