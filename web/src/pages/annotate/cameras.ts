/** What the parts of the annotator know of a recording's several cameras. */

import { createContext, useContext } from "react";
import type { TriangulatedJoint } from "../../api/triangulation";
import type { Camera } from "../../api/types";
import type { Size } from "../../canvas/view";

export interface Cameras {
  /** Those whose pictures are shown, in the recording's order; the active one is among them. */
  readonly shown: readonly Camera[];
  setShown(names: readonly string[]): void;
  /** The camera whose picture is enlarged. */
  readonly large: string | null;
  setLarge(camera: string | null): void;
  readonly areLinesShown: boolean;
  setLinesShown(areShown: boolean): void;
  /** The 21 joints of the active hand from the marks as they are stored now; null when no joint is marked twice. */
  readonly joints: readonly TriangulatedJoint[] | null;
  /** A picture says how large it is on the screen, px. */
  tellSize(camera: string, size: Size): void;
}

export const CamerasContext = createContext<Cameras | null>(null);

export function useCameras(): Cameras {
  const found = useContext(CamerasContext);
  if (!found) throw new Error("Parts of the annotator stand inside of it.");
  return found;
}
