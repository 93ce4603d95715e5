/** How the annotator shows pictures; kept in the browser, because it is a matter of the person and the screen. */

import { useLocalStorage } from "@mantine/hooks";
import type { PlaceMode } from "../actions/annotate/place";
import type { Camera } from "../api/types";
import type { Palette } from "../canvas/depth";

export type Arrangement = "color" | "depth" | "side" | "over";

export interface ViewOptions {
  readonly arrangement: Arrangement;
  /** Factors, 1 is as recorded. */
  readonly brightness: number;
  readonly contrast: number;
  readonly areHandsShown: boolean;
  readonly areNamesShown: boolean;
  readonly placeMode: PlaceMode;
  readonly palette: Palette;
  /** Of depth over colour, 0..1. */
  readonly depthOpacity: number;
  /** A finger places and drags joints; without it it only looks, so that nothing is marked by accident. */
  readonly isTouchMarking: boolean;
}

const DEFAULTS: ViewOptions = { arrangement: "color", brightness: 1, contrast: 1, areHandsShown: true, areNamesShown: false, placeMode: "joint", palette: "warm", depthOpacity: 0.55, isTouchMarking: false };

export function useViewOptions(): [ViewOptions, (change: Partial<ViewOptions>) => void] {
  const [options, setOptions] = useLocalStorage<ViewOptions>({ key: "handloom/view", defaultValue: DEFAULTS, getInitialValueInEffect: false });
  return [{ ...DEFAULTS, ...options }, (change) => setOptions((now) => ({ ...DEFAULTS, ...now, ...change }))];
}

export function arrangementsOf(camera: Camera): Arrangement[] {
  if (camera.has_color && camera.has_depth) return ["color", "depth", "side", "over"];
  return camera.has_depth ? ["depth"] : ["color"];
}

/** What is wanted if this camera can show it, else what it can. */
export const arrangementFor = (camera: Camera, wanted: Arrangement): Arrangement =>
  arrangementsOf(camera).includes(wanted) ? wanted : (arrangementsOf(camera)[0] ?? "color");

export const clampFactor = (value: number): number => Math.min(4, Math.max(0.25, Math.round(value * 100) / 100));
