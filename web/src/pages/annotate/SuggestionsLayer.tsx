import { Circle } from "react-konva";
import { GhostShape } from "../../canvas/HandShape";
import { toScreen } from "../../canvas/view";
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
    if (open.every((joint) => joint === null)) return null;
    return [
      // A dark ring below: violet alone is lost on skin.
      ...open.flatMap((joint, index) => (joint ? <Circle key={index} {...toScreen(view, { x: joint.px[0], y: joint.px[1] })} radius={4} stroke="#000" strokeWidth={5} opacity={0.6} /> : [])),
      <GhostShape key={hand} pose={asShape(open)} view={view} />,
    ];
  });
}
