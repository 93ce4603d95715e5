import { useCallback, useEffect, useId, useMemo, type ReactNode } from "react";
import { clickedJoint } from "../../actions/annotate/place";
import type { Camera } from "../../api/types";
import { ImagePane, type PaneLayer } from "../../canvas/ImagePane";
import type { Pictures } from "../../canvas/usePictures";
import { jointLabel } from "../../model/joints";
import { activePose } from "../../state/annotator";
import { pointerOn } from "../../state/pointer";
import { useSelect } from "../../state/useStore";
import { useAnnotating } from "./annotating";
import classes from "./Annotator.module.css";
import { CursorCurve } from "./EpipolarLayer";
import { LAYERS } from "./mounts";
import { describeClick } from "./nextClick";
import { OverJoint } from "./OverJoint";
import { paneGestures } from "./paneGestures";
import { useAnnotation, useOption, usePage } from "./reading";

interface PaneProps {
  camera: Camera;
  /** "Colour" */
  label: string;
  layers: readonly PaneLayer[];
  pictures: Pictures;
  /** In place of the label in the corner. */
  overlay?: ReactNode;
}

/** What a click does, in a word or two beside the cursor; nothing while something is dragged. */
function useCursorLabel(camera: string): string {
  const clicked = useAnnotation((state) => (state.draft ? null : clickedJoint(state)));
  const isDragged = useAnnotation((state) => state.draft !== null);
  const chosen = useSelect(useAnnotating().over, (over) => (over?.camera === camera ? over.joint : -1));
  if (isDragged) return "";
  if (chosen >= 0) return `choose ${jointLabel(chosen)}`;
  return clicked === null ? "" : jointLabel(clicked);
}

/** One picture of one camera, to be annotated. */
export function Pane({ camera, label, layers, pictures, overlay }: PaneProps) {
  const annotating = useAnnotating();
  const { hover, setView, noteDrawn } = annotating;
  const frame = useAnnotation((state) => state.frame);
  const view = usePage((page) => page.views[camera.id] ?? null);
  const placeMode = useOption("placeMode");
  const click = useAnnotation((state) => describeClick(state, activePose(state), placeMode));
  const cursorLabel = useCursorLabel(camera.id);
  const pointer = useMemo(() => pointerOn(hover, camera.id), [hover, camera.id]);
  const gestures = useMemo(() => paneGestures(annotating, camera.id), [annotating, camera.id]);
  const pane = useId();
  const onDrawn = useCallback((drawn: number | null) => noteDrawn(pane, camera.id, drawn), [noteDrawn, pane, camera.id]);
  useEffect(() => () => noteDrawn(pane, camera.id, null), [noteDrawn, pane, camera.id]);
  const { shownFrame } = pictures;
  return (
    <ImagePane
      {...gestures}
      label={`${label} of frame ${frame}, ${camera.id}. Next click ${click}.`}
      camera={camera}
      layers={layers}
      view={view}
      onView={(next) => setView(camera.id, next)}
      brightness={useOption("brightness")}
      contrast={useOption("contrast")}
      pointer={pointer}
      cursorLabel={pictures.isStale ? "" : cursorLabel}
      isMagnified={usePage((page) => page.isMagnified)}
      frame={frame}
      shownFrame={shownFrame}
      isTouchLooking={!useOption("isTouchMarking")}
      setback={pictures.setback}
      onRetry={pictures.retry}
      isRefused={usePage((page) => page.isRefused)}
      onDrawn={onDrawn}
      withCursor={(shown) => (
        <>
          <CursorCurve view={shown} camera={camera} />
          <OverJoint view={shown} camera={camera} />
        </>
      )}
      overlay={overlay ?? <span className={classes.paneLabel}>{label}</span>}
    >
      {(shown) => shownFrame !== null && LAYERS.map((Layer, index) => <Layer key={index} view={shown} camera={camera} frame={shownFrame} />)}
    </ImagePane>
  );
}
