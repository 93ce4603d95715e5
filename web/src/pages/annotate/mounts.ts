/**
 * Where the annotator's parts stand, each mounted by one line. A part reads through the hooks of `reading.ts`, acts through
 * `useAnnotating()`, and answers keys with `useActions()`; the key itself is a line of `model/keymap.ts`.
 */

import { useMemo, type ComponentType } from "react";
import type { Camera } from "../../api/types";
import type { View } from "../../canvas/view";
import { mergeMarks } from "../../model/frameMarks";
import { AssignmentBar } from "./AssignmentBar";
import { AssignmentComments } from "./AssignmentComments";
import { CamerasTool, CameraTools } from "./CamerasTool";
import { ConflictCards } from "./ConflictCards";
import { EpipolarLayer } from "./EpipolarLayer";
import { FlagCard, useFlagMarks } from "./FlagCard";
import { HandsLayer } from "./HandsLayer";
import { HistoryPanel } from "./HistoryPanel";
import { JointsPanel } from "./JointsPanel";
import { RefusalCards } from "./RefusalCards";
import { SuggestLayer } from "./SuggestLayer";
import { SuggestTool } from "./SuggestTool";
import { useSubmittedMarks } from "./useAssignmentHere";

/** Something drawn on a picture (Konva), in screen coordinates of the view. */
export interface LayerProps {
  view: View;
  camera: Camera;
  /** Which frame the picture is of: not always the one that the annotator is at. */
  frame: number;
}

export interface Panel {
  readonly id: string;
  readonly label: string;
  readonly Component: ComponentType;
}

/** Drawn on every picture, in order, the last one on top. */
export const LAYERS: readonly ComponentType<LayerProps>[] = [EpipolarLayer, SuggestLayer, HandsLayer];

/** Tabs of the panel on the right. */
export const PANELS: readonly Panel[] = [
  { id: "joints", label: "Joints", Component: JointsPanel },
  { id: "history", label: "History", Component: HistoryPanel },
  { id: "comments", label: "Comments", Component: AssignmentComments },
];

/** In the picture's upper right corner, one below the other; each draws nothing when it has nothing to say. */
export const CARDS: readonly ComponentType[] = [ConflictCards, RefusalCards, FlagCard];

/** Across the page, below the frame bar. */
export const BARS: readonly ComponentType[] = [AssignmentBar];

/** Buttons at the end of the frame bar. */
export const FRAME_TOOLS: readonly ComponentType[] = [CamerasTool, SuggestTool];

/** Buttons at the end of the tool rail. */
export const TOOLS: readonly ComponentType[] = [CameraTools];

/** Hooks that say which frames the timeline has to mark, in one. */
export function useMarks(): ReturnType<typeof mergeMarks> {
  const [flagged, submitted] = [useFlagMarks(), useSubmittedMarks()];
  return useMemo(() => mergeMarks([flagged, submitted]), [flagged, submitted]);
}
