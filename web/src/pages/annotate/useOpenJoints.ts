import { useMemo } from "react";
import { keyText, type PoseKey } from "../../model/pose";
import { openJoints, type OpenJoint } from "../../model/suggestion";
import { useAnnotation, useSuggestions } from "./reading";

/** What can be accepted for a hand: 21, null where the person decided already or nothing is proposed. */
export function useOpenJoints(place: PoseKey): readonly (OpenJoint | null)[] {
  const key = keyText(place);
  const suggested = useSuggestions((state) => state.byPlace[key]);
  const hidden = useSuggestions((state) => state.hidden);
  const pose = useAnnotation((state) => state.poses[key]);
  return useMemo(() => openJoints(suggested, pose, hidden), [suggested, pose, hidden]);
}
