import { useEffect } from "react";
import type { Camera } from "../../api/types";
import { toScreen, type Point, type View } from "../../canvas/view";
import type { Pose } from "../../model/pose";
import { useHover } from "../../state/pointer";
import { useAnnotating } from "./annotating";

interface OverJointProps {
  camera: Camera;
  view: View;
  pose: Pose;
  chosenAt: (view: View, screen: Point) => number;
}

/** A joint this near to the pointer, image px, was placed by the click just now: what is next is of more interest than it. */
const JUST_PLACED = 0.5;

/** Tells the cursor and the status line which joint a click would choose; drawn with the cursor, because it moves with it. */
export function OverJoint({ camera, view, pose, chosenAt }: OverJointProps) {
  const { hover, over } = useAnnotating();
  const here = useHover(hover);
  const near = here?.camera === camera.id ? chosenAt(view, toScreen(view, here.pixel)) : -1;
  const at = pose[near];
  const joint = here && at && Math.hypot(at.x - here.pixel.x, at.y - here.pixel.y) < JUST_PLACED ? -1 : near;
  useEffect(() => {
    if (joint < 0) return;
    over.set({ camera: camera.id, joint }, "person");
    return () => over.set(null, "person");
  }, [over, camera.id, joint]);
  return null;
}
