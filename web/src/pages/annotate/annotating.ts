/**
 * What every part of the annotator may read and do. The context never changes: a part reads through the hooks of `reading.ts`
 * and is drawn again only when what it reads is another. A part is a component of its own file, mounted by a line in `mounts.ts`.
 */

import { createContext, useContext, useEffect, useRef } from "react";
import type { Recording } from "../../api/types";
import type { DepthRange } from "../../canvas/depth";
import type { Pictures } from "../../canvas/usePictures";
import type { Size, View } from "../../canvas/view";
import type { Pose } from "../../model/pose";
import type { Action } from "../../state/annotator";
import type { HoverStore, OverStore } from "../../state/pointer";
import type { Session } from "../../state/session";
import type { WantedCameras } from "../../state/shownCameras";
import type { Store } from "../../state/store";
import type { ViewOptions } from "../../state/viewOptions";

/** Handlers by the ids of the key map; `repeats` counts how long a key has been held. */
export type Actions = Readonly<Record<string, (repeats?: number) => void>>;

/** What the page shows now beside the labels; gone with the page. */
export interface PageState {
  /** By camera; none fits the image. */
  readonly views: Readonly<Record<string, View | null>>;
  /** Depth colours, m; null chooses them from the image. */
  readonly range: DepthRange | null;
  readonly isMagnified: boolean;
  readonly isPlaying: boolean;
  /** Somebody tried to change labels of a picture that is not on the screen yet; until it is, the page says so. */
  readonly isRefused: boolean;
  /** Another version of the active hand to compare with, drawn as a ghost. */
  readonly preview: Pose | null;
  /** Why the labels cannot be changed here, or null. What would change them is then refused, and this is said. */
  readonly lock: string | null;
  readonly wantedCameras: WantedCameras;
  /** The camera whose picture is enlarged among several. */
  readonly largeCamera: string | null;
}

export interface Annotating {
  readonly recording: Store<Recording>;
  /** The blind replica that is marked, if one is. */
  readonly replica: string | null;
  readonly session: Session;
  readonly page: Store<PageState>;
  readonly options: Store<ViewOptions>;
  /** Of the active camera and frame; null before a picture was asked for. */
  readonly pictures: Store<Pictures | null>;
  /** In whichever camera's pictures the pointer is. */
  readonly hover: HoverStore;
  /** The joint that a click would choose where the pointer is. */
  readonly over: OverStore;
  /** How large the picture of each camera is on the screen, px. */
  readonly sizes: Map<string, Size>;

  show: (change: Partial<PageState>) => void;
  setOptions: (change: Partial<ViewOptions>) => void;
  setView: (camera: string, view: View | null) => void;
  /** Show these cameras' pictures side by side, by name. */
  showCameras: (names: readonly string[]) => void;
  /** Which frame of a camera is on the screen now, in one of its panes; null for none. */
  noteDrawn: (pane: string, camera: string, frame: number | null) => void;
  refuse: () => void;
  /**
   * A person's action: one step for undo, saved by itself. Labels are changed only in pictures that are on the screen, and not
   * while frames are played; says whether it was taken.
   */
  act: <I>(action: Action<I>, input: I) => boolean;
  /** What answers an id of the key map now. */
  answerTo: (id: string) => ((repeats?: number) => void) | undefined;
  /** Does what a key of this id would do. */
  run: (id: string, repeats?: number) => void;
  /** Does it once the picture that was gone to is drawn, if it is here already; steps go at once and wait by themselves. */
  press: (id: string, repeats: number) => void;
  /** Answers ids of the key map as long as it is not called off; what comes later goes first. */
  register: (actions: () => Actions) => () => void;
  /** Watches what its own state follows from; returns the way to stop. */
  start: () => () => void;
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
