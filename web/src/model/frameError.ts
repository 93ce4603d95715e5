/** How far the fit of each frame is from what was seen. */

import type { TrackFrames } from "../api/types";
import { ERROR_FULL_MM } from "./errorColor";

/** A detector's joints on real images are 5 px from marks at the median; four times that is a finger's breadth. */
const ERROR_FULL_PX = 20;

export interface FrameError {
  readonly label: string;
  readonly unit: "mm" | "px";
  /** From here on a frame is as bad as it can be. */
  readonly full: number;
  readonly values: readonly (number | null)[];
}

/** The depth residual; in several colour cameras the distance from the detector's joints in the worst of them. */
export function frameError(track: TrackFrames): FrameError {
  if (track.views.length === 0) return { label: "Depth residual", unit: "mm", full: ERROR_FULL_MM, values: track.depth_residual_mm };
  const values = track.frame.map((_, index) => {
    const known = track.views.flatMap(({ fit_px }) => fit_px[index] ?? []);
    return known.length > 0 ? Math.max(...known) : null;
  });
  return { label: "Fit to detector, worst camera", unit: "px", full: ERROR_FULL_PX, values };
}
