import type { QueryClient } from "@tanstack/react-query";
import { annotationKeys, fetchAnnotations, fetchKeyFrames, type PlaceOf } from "../../api/annotations";
import { sendVisit, type PersonHere } from "../../api/live";
import { teamKeys } from "../../api/teams";
import type { Annotation, Me, Recording } from "../../api/types";
import { keyText } from "../../model/pose";
import { enterRoom } from "../../state/live";
import { startMerging, type Label } from "../../state/merging";
import type { Session } from "../../state/session";
import { startVisit } from "../../state/visit";

interface Parts {
  recording: Recording;
  replica: string | null;
  session: Session;
  me: Me;
  /** As they were loaded for the session. */
  annotations: readonly Annotation[];
  client: QueryClient;
}

/** Nothing was loaded: everything that is there since is news. */
const BEGINNING = "1970-01-01T00:00:00Z";

/** Have an open recording follow what others do in it, until it is closed. */
export function openLive({ recording, replica, session, me, annotations, client }: Parts): () => void {
  const merging = startMerging(session.store, session.queue);
  const visitId = crypto.randomUUID();
  const isSeen = me.is_login_needed && replica === null;
  const visit = isSeen ? startVisit(session.store, (place) => sendVisit(recording.id, visitId, place)) : null;
  let sight: string | null = null;

  const reload = async (): Promise<void> => {
    const [labels, keys] = await Promise.all([fetchAnnotations(recording.id, replica), fetchKeyFrames(recording.id, replica)]);
    merging.reload(labels);
    session.keyFrames.learn(keys.map(keyText));
  };

  const leave = enterRoom({
    path: `/sequences/${recording.id}/live`,
    query: { reader: me.id, visit: visitId, ...(replica ? { replica } : {}) },
    since: annotations.reduce((newest, { updated_at: at }) => (Date.parse(at) > Date.parse(newest) ? at : newest), BEGINNING),
    handlers: {
      label: (data) => {
        merging.hear(data as Label);
        void client.invalidateQueries({ queryKey: annotationKeys.history(recording.id, keyText(data as Label)) });
      },
      keys: (data) => session.keyFrames.learn((data as { items: PlaceOf[] }).items.map(keyText)),
      people: (data) => session.people.set((data as { items: PersonHere[] }).items, "server"),
      work: () => void client.invalidateQueries({ queryKey: teamKeys }),
      sight: (data) => {
        const { digest } = data as { digest: string };
        // What may be seen is another than when it was loaded.
        if (sight !== null && digest !== sight) void reload().catch(() => undefined);
        sight = digest;
      },
      end: () => leave(),
    },
    onOpen: () => visit?.now(),
  });
  return () => {
    leave();
    visit?.stop();
    merging.stop();
  };
}
