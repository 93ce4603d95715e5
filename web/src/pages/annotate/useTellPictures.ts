import { useLayoutEffect } from "react";
import type { Pictures } from "../../canvas/usePictures";
import { useAnnotating } from "./annotating";

/** Tells the other parts which pictures the active camera has; only the pane of that camera tells them. */
export function useTellPictures(pictures: Pictures, isActive: boolean): void {
  const { pictures: told } = useAnnotating();
  useLayoutEffect(() => {
    if (isActive) told.set(pictures, "person");
  }, [told, pictures, isActive]);
}
