/** What of a hand is drawn, and how. */

export type Layers = "scan" | "mesh" | "both";
export type ViewSide = "palm" | "back" | "thumb" | "little";

export interface Look {
  readonly layers: Layers;
  readonly hasErrors: boolean;
  readonly hasWireframe: boolean;
  readonly hasCorrespondences: boolean;
  readonly isTurning: boolean;
}

export const FIRST_LOOK: Look = { layers: "both", hasErrors: false, hasWireframe: false, hasCorrespondences: false, isTurning: false };
