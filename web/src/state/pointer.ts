/** Where the pointer is, in image pixels; apart from the rest of the state, because it changes with every movement. */

import type { Point } from "../canvas/view";
import { createStore, type Store } from "./store";

export type PointerStore = Store<Point | null>;

export const createPointerStore = (): PointerStore => createStore<Point | null>(null);

/** The pointer in one of several cameras' pictures. */
export interface Hover {
  readonly camera: string;
  readonly pixel: Point;
}

export type HoverStore = Store<Hover | null>;

export const createHoverStore = (): HoverStore => createStore<Hover | null>(null);

/** The joint that a click would choose, in a camera's pictures. */
export interface Over {
  readonly camera: string;
  readonly joint: number;
}

export type OverStore = Store<Over | null>;

export const createOverStore = (): OverStore => createStore<Over | null>(null);

/** The pointer as the pictures of one camera know it. */
export function pointerOn(hover: HoverStore, camera: string): PointerStore {
  const pixelOf = (value: Hover | null): Point | null => (value?.camera === camera ? value.pixel : null);
  return {
    get: () => pixelOf(hover.get()),
    set(pixel, origin) {
      if (pixel) hover.set({ camera, pixel }, origin);
      else if (hover.get()?.camera === camera) hover.set(null, origin);
    },
    watch: (watcher) => hover.watch((now, before, origin) => watcher(pixelOf(now), pixelOf(before), origin)),
  };
}
