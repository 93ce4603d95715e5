/** What every part of the annotator may read and do. A part is a component of its own file, mounted by a line in `mounts.ts`. */

import { createContext, useContext, useEffect, useRef } from "react";
import type { Camera, Recording } from "../../api/types";
import type { DepthRange } from "../../canvas/depth";
import type { Pictures } from "../../canvas/usePictures";
import type { View } from "../../canvas/view";
import type { Pose } from "../../model/pose";
import type { Action, AnnotatorState } from "../../state/annotator";
import type { HoverStore, OverStore, PointerStore } from "../../state/pointer";
import type { SaveStatus } from "../../state/saveQueue";
import type { Session } from "../../state/session";
import type { Arrangement, ViewOptions } from "../../state/viewOptions";

/** Handlers by the ids of the key map; `repeats` counts how long a key has been held. */
export type Actions = Readonly<Record<string, (repeats?: number) => void>>;

export interface Annotating {
  readonly recording: Recording;
  readonly session: Session;
  readonly state: AnnotatorState;
  /** The active camera. */
  readonly camera: Camera;
  /** The active hand as it is to be drawn. */
  readonly pose: Pose;
  readonly saving: SaveStatus;
  /** Of the active camera and frame. */
  readonly pictures: Pictures;
  /** Depth colours, m; null chooses them from the image. */
  readonly range: DepthRange | null;
  setRange(range: DepthRange | null): void;
  readonly arrangement: Arrangement;
  readonly options: ViewOptions;
  setOptions(change: Partial<ViewOptions>): void;
  /** Null fits the image. */
  viewOf(camera: string): View | null;
  setView(camera: string, view: View | null): void;
  /** Which frame of a camera is on the screen now, in one of its panes; null for none. */
  noteDrawn(pane: string, camera: string, frame: number | null): void;
  /** Somebody tried to change labels of a picture that is not on the screen yet; until it is, the page says so. */
  readonly isRefused: boolean;
  refuse(): void;
  /** In the pictures of the active camera. */
  readonly pointer: PointerStore;
  /** In whichever camera's pictures it is. */
  readonly hover: HoverStore;
  /** The joint that a click would choose where the pointer is. */
  readonly over: OverStore;
  readonly isMagnified: boolean;
  readonly isPlaying: boolean;
  /** Another version of the active hand to compare with, drawn as a ghost. */
  readonly preview: Pose | null;
  setPreview(pose: Pose | null): void;
  /** Why the labels cannot be changed here, or null. What would change them is then refused, and this is said. */
  readonly lock: string | null;
  setLock(reason: string | null): void;
  /**
   * A person's action: one step for undo, saved by itself. Labels are changed only in pictures that are on the screen, and not
   * while frames are played; says whether it was taken.
   */
  act<I>(action: Action<I>, input: I): boolean;
  /** Does what a key of this id would do. */
  run(id: string, repeats?: number): void;
  /** Answers ids of the key map as long as it is not called off; what comes later goes first. */
  register(actions: () => Actions): () => void;
}

export const AnnotatingContext = createContext<Annotating | null>(null);

export function useAnnotating(): Annotating {
  const found = useContext(AnnotatingContext);
  if (!found) throw new Error("Parts of the annotator stand inside of it.");
  return found;
}

/** Answer ids of the key map (their keys and their buttons) while the part is there. */
export function useActions(actions: Actions): void {
  const { register } = useAnnotating();
  const current = useRef(actions);
  current.current = actions;
  useEffect(() => register(() => current.current), [register]);
}
