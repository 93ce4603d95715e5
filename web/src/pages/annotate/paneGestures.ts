import { activateCamera } from "../../actions/annotate/cameras";
import { cancelDrag, dragHand, dragJoint, endDrag } from "../../actions/annotate/move";
import { clickedJoint, placeIn } from "../../actions/annotate/place";
import { selectJoint } from "../../actions/annotate/select";
import { turnHand } from "../../actions/annotate/turn";
import { cycleVisibility } from "../../actions/annotate/visibility";
import { CHOOSE_RADIUS, HIT_RADIUS, jointAt } from "../../canvas/hit";
import type { PaneGestures } from "../../canvas/usePaneGestures";
import type { TouchGestures } from "../../canvas/useTouch";
import type { Point, View } from "../../canvas/view";
import { poseIn } from "../../state/annotator";
import type { Annotating } from "./annotating";
import { createSuggestDouble } from "./suggestDouble";

/** The joint of the active hand near a point of a camera's picture, or -1. */
function jointNear({ session, options }: Annotating, camera: string, view: View, screen: Point, radius: number): number {
  const state = session.store.get();
  return options.get().areHandsShown ? jointAt(poseIn(state, camera), view, screen, camera === state.camera ? state.joint : -1, radius) : -1;
}

/** Fingertips of a fist lie close together: while a joint waits to be placed, only a click on a disc chooses another one. */
export function jointChosenAt(annotating: Annotating, camera: string, view: View, screen: Point): number {
  const isWaiting = clickedJoint(activateCamera(annotating.session.store.get(), camera)) !== null;
  return jointNear(annotating, camera, view, screen, isWaiting ? CHOOSE_RADIUS : HIT_RADIUS);
}

/** What gestures on a camera's picture do; one on a camera that is not the active one makes it so first. */
export function paneGestures(annotating: Annotating, camera: string): PaneGestures & Pick<TouchGestures, "onSwipe"> {
  const { session, options, act, run, refuse } = annotating;
  const here = (): void => void act(activateCamera, camera);
  const { notePlace, onDouble } = createSuggestDouble(annotating, camera);
  return {
    onSwipe: (by) => run(by > 0 ? "frame.next" : "frame.previous"),
    onRefused: refuse,
    hitJoint: (view, screen) => jointNear(annotating, camera, view, screen, HIT_RADIUS),
    chosenAt: (view, screen) => jointChosenAt(annotating, camera, view, screen),
    onDouble,
    onPlace: (pixel) => {
      here();
      if (act(placeIn[options.get().placeMode], pixel)) notePlace();
    },
    onSelect: (joint) => {
      here();
      act(selectJoint, joint);
    },
    onDragJoint: (joint, to) => {
      here();
      act(dragJoint, { joint, to });
    },
    onDragHand: (by) => {
      here();
      act(dragHand, by);
    },
    onTurnHand: (turn) => {
      here();
      act(turnHand, turn);
    },
    isDragOn: () => session.store.get().draft !== null,
    onSpacePan: () => run("play"),
    onDragEnd: () => void act(endDrag, undefined),
    onDragCancel: () => void act(cancelDrag, undefined),
    onCycle: (joint) => {
      here();
      act(cycleVisibility, joint);
    },
  };
}
