/** Says where the person is in a recording, when they move and now and again, so that others see it. */

import type { PersonHere } from "../api/live";
import type { AnnotatorState } from "./annotator";
import type { Store } from "./store";

/** While somebody moves, others hear of it so often. */
const PAUSE_MS = 400;
/** Somebody who was not heard for 25 s counts as gone. */
const STILL_HERE_MS = 10_000;

export interface VisitReport {
  now: () => void;
  stop: () => void;
}

export function startVisit(store: Store<AnnotatorState>, send: (place: Omit<PersonHere, "name">) => void): VisitReport {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const now = (): void => {
    clearTimeout(timer);
    timer = undefined;
    const { camera, frame, hand } = store.get();
    send({ camera, frame, hand });
  };
  const stopWatching = store.watch((state, before) => {
    const isElsewhere = state.camera !== before.camera || state.frame !== before.frame || state.hand !== before.hand;
    if (isElsewhere) timer ??= setTimeout(now, PAUSE_MS);
  });
  const repeating = setInterval(now, STILL_HERE_MS);
  return {
    now,
    stop() {
      clearTimeout(timer);
      clearInterval(repeating);
      stopWatching();
    },
  };
}
