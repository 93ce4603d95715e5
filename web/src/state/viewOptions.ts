/** How the annotator shows pictures; kept in the browser, because it is a matter of the person and the screen. */

import { PLACE_MODES, type PlaceMode } from "../actions/annotate/place";
import type { Camera } from "../api/types";
import type { Palette } from "../canvas/depth";
import { createKept } from "./kept";
import type { Store } from "./store";

export type Arrangement = "color" | "depth" | "side" | "over";

export interface ViewOptions {
  readonly arrangement: Arrangement;
  /** Factors, 1 is as recorded. */
  readonly brightness: number;
  readonly contrast: number;
  readonly areHandsShown: boolean;
  readonly areNamesShown: boolean;
  /** Epipolar lines of the active joint and of the cursor, between several cameras. */
  readonly areLinesShown: boolean;
  readonly placeMode: PlaceMode;
  readonly palette: Palette;
  /** Of depth over colour, 0..1. */
  readonly depthOpacity: number;
  /** A finger places and drags joints; without it it only looks, so that nothing is marked by accident. */
  readonly isTouchMarking: boolean;
}

const DEFAULTS: ViewOptions = {
  arrangement: "color",
  brightness: 1,
  contrast: 1,
  areHandsShown: true,
  areNamesShown: false,
  areLinesShown: true,
  placeMode: "joint",
  palette: "warm",
  depthOpacity: 0.55,
  isTouchMarking: false,
};

const parse = (found: unknown): ViewOptions => (typeof found === "object" ? { ...DEFAULTS, ...found } : DEFAULTS);

let options: Store<ViewOptions> | null = null;

/** The options of this browser: one store, whichever recording is open. */
export const viewOptions = (): Store<ViewOptions> => (options ??= createKept("handloom/view", parse));

export function arrangementsOf(camera: Camera): Arrangement[] {
  if (camera.has_color && camera.has_depth) return ["color", "depth", "side", "over"];
  return camera.has_depth ? ["depth"] : ["color"];
}

/** What is wanted if this camera can show it, else what it can. */
export const arrangementFor = (camera: Camera, wanted: Arrangement): Arrangement =>
  arrangementsOf(camera).includes(wanted) ? wanted : (arrangementsOf(camera)[0] ?? "color");

export const clampFactor = (value: number): number => Math.min(4, Math.max(0.25, Math.round(value * 100) / 100));

const next = <T>(all: readonly T[], now: T): T => all[(all.indexOf(now) + 1) % all.length] ?? now;

export const nextArrangement = (camera: Camera, now: Arrangement): Arrangement => next(arrangementsOf(camera), arrangementFor(camera, now));

export const nextPlaceMode = (now: PlaceMode): PlaceMode => next(PLACE_MODES, now);
