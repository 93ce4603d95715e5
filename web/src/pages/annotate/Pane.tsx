import { cancelDrag, dragHand, dragJoint, endDrag } from "../../actions/annotate/move";
import { clickedJoint, placeIn } from "../../actions/annotate/place";
import { activateCamera } from "../../actions/annotate/cameras";
import { selectJoint } from "../../actions/annotate/select";
import { turnHand } from "../../actions/annotate/turn";
import { cycleVisibility } from "../../actions/annotate/visibility";
import { useCallback, useEffect, useId, useMemo, type ReactNode } from "react";
import type { Camera } from "../../api/types";
import { CHOOSE_RADIUS, HIT_RADIUS, jointAt } from "../../canvas/hit";
import { ImagePane, type PaneLayer } from "../../canvas/ImagePane";
import type { Pictures } from "../../canvas/usePictures";
import type { Point, View } from "../../canvas/view";
import { jointLabel } from "../../model/joints";
import { emptyPose, keyText } from "../../model/pose";
import { pointerOn, useOver } from "../../state/pointer";
import { useAnnotating } from "./annotating";
import classes from "./Annotator.module.css";
import { CursorCurve } from "./EpipolarLayer";
import { LAYERS } from "./mounts";
import { describeClick } from "./nextClick";
import { OverJoint } from "./OverJoint";
import { useSuggestDouble } from "./useSuggestDouble";

interface PaneProps {
  camera: Camera;
  /** "Colour" */
  label: string;
  layers: readonly PaneLayer[];
  pictures: Pictures;
  /** In place of the label in the corner. */
  overlay?: ReactNode;
}

/** One picture of one camera, to be annotated; a gesture on a camera that is not the active one makes it so first. */
export function Pane({ camera, label, layers, pictures, overlay }: PaneProps) {
  const { session, state, pose, options, viewOf, setView, noteDrawn, isRefused, refuse, hover, over, isMagnified, act, run } = useAnnotating();
  const isActive = camera.id === state.camera;
  const shown = isActive ? pose : (state.poses[keyText({ camera: camera.id, frame: state.frame, hand: state.hand })] ?? emptyPose());
  const here = (): void => void act(activateCamera, camera.id);
  const pointer = useMemo(() => pointerOn(hover, camera.id), [hover, camera.id]);
  const { notePlace, onDouble } = useSuggestDouble(camera);
  const pane = useId();
  const onDrawn = useCallback((frame: number | null) => noteDrawn(pane, camera.id, frame), [noteDrawn, pane, camera.id]);
  useEffect(() => () => noteDrawn(pane, camera.id, null), [noteDrawn, pane, camera.id]);
  const { shownFrame } = pictures;
  const clicked = clickedJoint(state);
  const chosen = useOver(over);
  const cursorLabel = pictures.isStale || state.draft !== null ? "" : chosen?.camera === camera.id ? `choose ${jointLabel(chosen.joint)}` : clicked === null ? "" : jointLabel(clicked);
  const jointNear = (view: View, screen: Point, radius: number): number => (options.areHandsShown ? jointAt(shown, view, screen, isActive ? state.joint : -1, radius) : -1);
  // Fingertips of a fist lie close together: while a joint waits to be placed, only a click on a disc chooses another one.
  const chosenAt = (view: View, screen: Point): number => jointNear(view, screen, clickedJoint(activateCamera(state, camera.id)) === null ? HIT_RADIUS : CHOOSE_RADIUS);
  return (
    <ImagePane
      label={`${label} of frame ${state.frame}, ${camera.id}. Next click ${describeClick(state, pose, options.placeMode)}.`}
      camera={camera}
      layers={layers}
      view={viewOf(camera.id)}
      onView={(view) => setView(camera.id, view)}
      brightness={options.brightness}
      contrast={options.contrast}
      pointer={pointer}
      cursorLabel={cursorLabel}
      isMagnified={isMagnified}
      frame={state.frame}
      shownFrame={shownFrame}
      isTouchLooking={!options.isTouchMarking}
      onSwipe={(by) => run(by > 0 ? "frame.next" : "frame.previous")}
      setback={pictures.setback}
      onRetry={pictures.retry}
      isRefused={isRefused}
      onDrawn={onDrawn}
      onRefused={refuse}
      hitJoint={(view, screen) => jointNear(view, screen, HIT_RADIUS)}
      chosenAt={chosenAt}
      onDouble={onDouble}
      onPlace={(pixel) => {
        here();
        if (act(placeIn[options.placeMode], pixel)) notePlace();
      }}
      onSelect={(joint) => {
        here();
        act(selectJoint, joint);
      }}
      onDragJoint={(joint, to) => {
        here();
        act(dragJoint, { joint, to });
      }}
      onDragHand={(by) => {
        here();
        act(dragHand, by);
      }}
      onTurnHand={(turn) => {
        here();
        act(turnHand, turn);
      }}
      isDragOn={() => session.store.get().draft !== null}
      onSpacePan={() => run("play")}
      onDragEnd={() => void act(endDrag, undefined)}
      onDragCancel={() => void act(cancelDrag, undefined)}
      onCycle={(joint) => {
        here();
        act(cycleVisibility, joint);
      }}
      withCursor={(view) => (
        <>
          <CursorCurve view={view} camera={camera} />
          <OverJoint view={view} camera={camera} pose={shown} chosenAt={chosenAt} />
        </>
      )}
      overlay={overlay ?? <span className={classes.paneLabel}>{label}</span>}
    >
      {(view) => shownFrame !== null && LAYERS.map((Layer, index) => <Layer key={index} view={view} camera={camera} frame={shownFrame} />)}
    </ImagePane>
  );
}
