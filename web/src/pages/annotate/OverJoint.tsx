import { useEffect } from "react";
import type { Camera } from "../../api/types";
import { toScreen, type View } from "../../canvas/view";
import { poseIn } from "../../state/annotator";
import { useStore } from "../../state/useStore";
import { useAnnotating } from "./annotating";
import { jointChosenAt } from "./paneGestures";
import { useAnnotation, useOption } from "./reading";

/** A joint this near to the pointer, image px, was placed by the click just now: what is next is of more interest than it. */
const JUST_PLACED = 0.5;

/** Tells the cursor and the status line which joint a click would choose; drawn with the cursor, because it moves with it. */
export function OverJoint({ camera, view }: { camera: Camera; view: View }) {
  const annotating = useAnnotating();
  const { hover, over } = annotating;
  const here = useStore(hover);
  const areHandsShown = useOption("areHandsShown");
  const joint = useAnnotation((state) => {
    if (!areHandsShown || here?.camera !== camera.id || state.draft) return -1;
    const near = jointChosenAt(annotating, camera.id, view, toScreen(view, here.pixel));
    const at = poseIn(state, camera.id)[near];
    return at && Math.hypot(at.x - here.pixel.x, at.y - here.pixel.y) < JUST_PLACED ? -1 : near;
  });
  useEffect(() => {
    if (joint < 0) return;
    over.set({ camera: camera.id, joint }, "person");
    return () => over.set(null, "person");
  }, [over, camera.id, joint]);
  return null;
}
