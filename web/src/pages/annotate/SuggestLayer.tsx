import { SuggestShape } from "../../canvas/SuggestShape";
import { HANDS } from "../../model/joints";
import { keyText } from "../../model/pose";
import { activePose } from "../../state/annotator";
import type { LayerProps } from "./mounts";
import { useAnnotation, useOption } from "./reading";
import { useOpenJoints } from "./useOpenJoints";
import type { Side } from "../../api/types";

/** What is suggested for one hand of a picture. */
function SuggestedHand({ hand, view, camera, frame }: LayerProps & { hand: Side }) {
  const place = { camera: camera.id, frame, hand };
  const open = useOpenJoints(place);
  const isEmpty = open.every((joint) => joint === null);
  const active = useAnnotation((state) => (camera.id === state.camera && frame === state.frame && hand === state.hand ? state.joint : -1));
  // Lines go to what is marked already; without a suggestion there are none.
  const pose = useAnnotation((state) => (isEmpty ? undefined : active >= 0 ? activePose(state) : state.poses[keyText(place)]));
  return isEmpty ? null : <SuggestShape open={open} pose={pose} hand={hand} view={view} active={active} />;
}

/** What is suggested for either hand of a picture, below what people marked. */
export function SuggestLayer(props: LayerProps) {
  if (!useOption("areHandsShown")) return null;
  return HANDS.map((hand) => <SuggestedHand key={hand} hand={hand} {...props} />);
}
