/** Where the pointer is, in image pixels; apart from the rest of the state, because it changes with every movement. */

import { useSyncExternalStore } from "react";
import type { Point } from "../canvas/view";
import { createStore, type Store } from "./store";

export type PointerStore = Store<Point | null>;

export const createPointerStore = (): PointerStore => createStore<Point | null>(null);

export const usePointer = (pointer: PointerStore): Point | null => useSyncExternalStore((tell) => pointer.watch(tell), pointer.get);
