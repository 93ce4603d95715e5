import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef, useState, type RefObject } from "react";
import { fetchPattern } from "../../api/handModels";
import { fetchRegistrationGeometry } from "../../api/registrations";
import { createShelf, type Shelf } from "../../canvas/hand3d/shelf";
import type { Stage } from "../../canvas/hand3d/stage";
import { shownIn, soonShown, type Curation } from "../../state/curation";

/** A hand that is drawn comes to the screen before the next ones are asked for: without a graphics card both take the same processor. */
const AFTER_DRAWING_MS = 150;

interface ShownHand {
  /** Whether the hand that is wanted is drawn. */
  readonly isDrawn: boolean;
  readonly failure: Error | null;
  readonly retry: () => void;
}

/**
 * Draws what the queue stands at, at once when it is on the shelf, and before React hears of it. `drawn` is told which
 * one a drawing showed.
 */
export function useShownHand(stage: Stage | null, curation: Curation, drawn: RefObject<string>): ShownHand {
  const [now, setNow] = useState<{ id: string | null; isDrawn: boolean; failure: Error | null }>({ id: null, isDrawn: false, failure: null });
  const client = useQueryClient();
  const shelf = useRef<Shelf | null>(null);

  useEffect(() => {
    if (!stage) return;
    const made = createShelf(stage, async (id, signal) => {
      const item = curation.store.get().items.find((one) => one.id === id);
      if (!item) throw new Error("It is not in the queue any more.");
      return fetchRegistrationGeometry(item, await fetchPattern(client, item.model_id), signal);
    });
    shelf.current = made;
    let shown: string | null = null;
    const present = (): void => {
      const state = curation.store.get();
      const item = shownIn(state);
      const hand = item && made.get(item.id);
      const id = item?.id ?? null;
      if (hand && shown !== id) {
        drawn.current = item.id;
        stage.show(hand);
        shown = item.id;
      } else if (!hand && shown !== null) {
        drawn.current = "";
        stage.show(null);
        shown = null;
      }
      const failure = item ? made.failureOf(item.id) : null;
      setNow((before) => (before.id === id && before.isDrawn === Boolean(hand) && before.failure === failure ? before : { id, isDrawn: Boolean(hand), failure }));
    };
    let asking: ReturnType<typeof setTimeout> | undefined;
    const follow = (): void => {
      present();
      const ids = soonShown(curation.store.get()).map((item) => item.id);
      clearTimeout(asking);
      asking = setTimeout(() => made.want(ids), ids[0] !== undefined && made.get(ids[0]) ? AFTER_DRAWING_MS : 0);
    };
    const stopFollowing = curation.store.watch(follow);
    const stopWatching = made.watch(present);
    follow();
    return () => {
      clearTimeout(asking);
      stopFollowing();
      stopWatching();
      drawn.current = "";
      stage.show(null);
      made.stop();
      shelf.current = null;
    };
  }, [stage, curation, drawn, client]);

  return { ...now, retry: () => now.id !== null && shelf.current?.retry(now.id) };
}
