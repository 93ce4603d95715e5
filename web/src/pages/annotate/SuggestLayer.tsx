import { SuggestShape } from "../../canvas/SuggestShape";
import { HANDS } from "../../model/joints";
import { keyText } from "../../model/pose";
import { openJointsAt } from "../../state/suggestions";
import { useAnnotating } from "./annotating";
import type { LayerProps } from "./mounts";
import { useSuggestions } from "./useSession";

/** What is suggested for either hand of a picture, below what people marked. */
export function SuggestLayer({ view, camera, frame }: LayerProps) {
  const { session, state, pose, options } = useAnnotating();
  const suggestions = useSuggestions(session);
  if (!options.areHandsShown) return null;
  return HANDS.map((hand) => {
    const place = { camera: camera.id, frame, hand };
    const open = openJointsAt(suggestions, state, place);
    if (open.every((joint) => joint === null)) return null;
    const isActive = camera.id === state.camera && frame === state.frame && hand === state.hand;
    return <SuggestShape key={hand} open={open} pose={isActive ? pose : state.poses[keyText(place)]} hand={hand} view={view} active={isActive ? state.joint : -1} />;
  });
}
