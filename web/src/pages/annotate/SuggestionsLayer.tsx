import { GhostShape } from "../../canvas/HandShape";
import { HANDS } from "../../model/joints";
import { asShape } from "../../model/suggestion";
import { openJointsAt } from "../../state/suggestions";
import { useAnnotating } from "./annotating";
import type { LayerProps } from "./mounts";
import { useSuggestions } from "./useSession";

/** What machines propose for both hands in this picture: violet and dashed, until a person accepts it. */
export function SuggestionsLayer({ view, camera }: LayerProps) {
  const { session, state, options } = useAnnotating();
  const suggestions = useSuggestions(session);
  if (!options.areHandsShown) return null;
  return HANDS.map((hand) => {
    const open = openJointsAt(suggestions, state, { camera: camera.id, frame: state.frame, hand });
    return open.some((joint) => joint !== null) && <GhostShape key={hand} pose={asShape(open)} view={view} />;
  });
}
