import { acceptHand } from "../../actions/annotate/accept";
import { selectCamera, switchHand } from "../../actions/annotate/select";
import { jointAt } from "../../canvas/hit";
import type { Point, View } from "../../canvas/view";
import { HANDS } from "../../model/joints";
import { asShape } from "../../model/suggestion";
import { openJointsAt } from "../../state/suggestions";
import type { Annotating } from "./annotating";

/** A second click this soon after the first makes both a double click, whose first one was not meant to place anything. */
const DOUBLE_MS = 700;

/** A double click on a suggested hand accepts it for editing. `notePlace` is told of every click that places. */
export function createSuggestDouble({ session, page, options, act, run }: Annotating, camera: string): { notePlace: () => void; onDouble: (view: View, screen: Point) => boolean } {
  let placed = -Infinity;
  return {
    notePlace: () => {
      placed = performance.now();
    },
    onDouble: (view, screen) => {
      if (!options.get().areHandsShown || page.get().lock !== null) return false;
      const isPlacedJustNow = performance.now() - placed < DOUBLE_MS;
      placed = -Infinity;
      if (isPlacedJustNow) run("undo");
      const { frame } = session.store.get();
      const hand = HANDS.find((one) => {
        const open = openJointsAt(session.suggestions.get(), session.store.get(), { camera, frame, hand: one });
        return jointAt(asShape(open), view, screen, -1) >= 0;
      });
      if (hand === undefined) {
        if (isPlacedJustNow) run("redo");
        return false;
      }
      act(selectCamera, camera);
      if (session.store.get().hand !== hand) act(switchHand, undefined);
      act(acceptHand, session.suggestions.get());
      return true;
    },
  };
}
