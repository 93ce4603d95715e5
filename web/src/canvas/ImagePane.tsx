import { useElementSize, useMergedRef } from "@mantine/hooks";
import type Konva from "konva";
import { useCallback, useEffect, useLayoutEffect, useRef, useState, type ReactNode } from "react";
import { Image, Layer, Rect, Stage } from "./shapes";
import type { Camera } from "../api/types";
import type { PointerStore } from "../state/pointer";
import { CursorLayer } from "./CursorLayer";
import type { Setback } from "./frameCache";
import { PictureNote } from "./PictureNote";
import { usePaneGestures, type PaneGestures } from "./usePaneGestures";
import { useTouch, type TouchGestures } from "./useTouch";
import type { Picture } from "./usePictures";
import { fitView, type View } from "./view";
import classes from "./ImagePane.module.css";

export interface PaneLayer {
  readonly picture: Picture | null;
  readonly opacity: number;
}

interface ImagePaneProps extends PaneGestures, TouchGestures {
  label: string;
  camera: Camera;
  /** Drawn in order, the first one below. */
  layers: readonly PaneLayer[];
  /** The frame that is wanted. Gestures that change something are taken while it is the one on the screen, which `data-drawn` says. */
  frame: number;
  /** Which frame the layers are of; null before the first one has come. */
  shownFrame: number | null;
  /** Why the wanted one is not here, and how to ask again. */
  setback: Setback | null;
  onRetry: () => void;
  /** Somebody tried to change something meanwhile. */
  isRefused?: boolean;
  /** Told whenever it was drawn, with the frame that is on the screen now; null when there is none. */
  onDrawn?: (frame: number | null) => void;
  /** Null fits the image. */
  view: View | null;
  onView: (view: View | null) => void;
  brightness: number;
  contrast: number;
  pointer: PointerStore;
  /** What stands beside the cursor. */
  cursorLabel: string;
  isMagnified: boolean;
  children: (view: View) => ReactNode;
  /** Drawn on a layer of its own, with the cursor. */
  withCursor?: (view: View) => ReactNode;
  /** Things that lie on top, in the pane's corners. */
  overlay?: ReactNode;
}

/** Above this zoom pixels are shown as squares. */
const SQUARE_PIXELS = 3;

/** Chromium goes on showing what was on a canvas that is cleared and not drawn on again: something, unseen, always is drawn. */
const KeepAlive = () => <Rect width={1} height={1} fill="#000" opacity={0.01} listening={false} />;

/** One picture with what is drawn on it; zoom, pan and the pointer are handled here, in image pixels for everybody else. */
export function ImagePane(props: ImagePaneProps) {
  const { label, camera, layers, view, onView, brightness, contrast, pointer, cursorLabel, isMagnified, children, withCursor, overlay, frame, shownFrame, setback, onRetry, isRefused = false, onDrawn } = props;
  const { ref: sizeRef, width, height } = useElementSize();
  const surface = useRef<HTMLDivElement | null>(null);
  // One that stays: with a new one at each render the pane is out of reach for a moment, and a picture drawn then was never noted.
  const held = useMergedRef(surface, sizeRef);
  // The stage draws its own tree, sometimes after the effects of this one: its layer is told of, not looked for.
  const [imageLayer, setImageLayer] = useState<Konva.Layer | null>(null);
  const shownView = view ?? fitView(camera, { width, height });
  const onScreen = useRef<number | null>(null);
  const wanted = useRef(frame);
  wanted.current = frame;
  const live = useCallback(() => (onScreen.current === wanted.current ? onScreen.current : null), []);
  const mouse = usePaneGestures(surface, shownView, { width, height }, camera, onView, pointer, live, props);
  const handlers = useTouch(mouse, { view: shownView, isFitted: view === null, pane: { width, height }, image: camera, onView }, props);

  useEffect(() => {
    // The browser's own filter on the picture's layer costs nothing; Konva's filters would redo every pixel.
    const canvas = imageLayer?.getNativeCanvasElement();
    if (canvas) canvas.style.filter = brightness === 1 && contrast === 1 ? "" : `brightness(${brightness}) contrast(${contrast})`;
  });

  const drawable = layers.flatMap(({ picture }) => (picture && picture.width > 0 ? [picture] : []));
  const meant = useRef<{ pictures: readonly Picture[]; frame: number | null; onDrawn: typeof onDrawn }>({ pictures: [], frame: null, onDrawn });
  useLayoutEffect(() => {
    meant.current = { pictures: drawable, frame: shownFrame, onDrawn };
  });
  useEffect(() => {
    const tell = (drawn: number | null): void => {
      const isNew = onScreen.current !== drawn;
      onScreen.current = drawn;
      meant.current.onDrawn?.(drawn);
      if (!surface.current || !isNew) return;
      if (drawn === null) delete surface.current.dataset["drawn"];
      else surface.current.dataset["drawn"] = String(drawn);
    };
    const note = (): void => {
      const { pictures, frame: of } = meant.current;
      const images = imageLayer?.find<Konva.Image>("Image") ?? [];
      const isOnScreen = pictures.length > 0 && images.length === pictures.length && images.every((image, index) => image.image() === pictures[index]);
      tell(isOnScreen ? of : null);
    };
    imageLayer?.on("draw", note);
    // What was drawn before is noted, too.
    imageLayer?.batchDraw();
    return () => {
      imageLayer?.off("draw", note);
      tell(null);
    };
  }, [imageLayer]);

  const pictures = layers.flatMap(({ picture, opacity }, index) =>
    picture && picture.width > 0 ? (
      <Image
        key={index}
        image={picture}
        x={shownView.x}
        y={shownView.y}
        width={camera.width * shownView.scale}
        height={camera.height * shownView.scale}
        opacity={opacity}
      />
    ) : (
      []
    ),
  );
  return (
    <div
      ref={held}
      className={classes.pane}
      role="application"
      aria-label={label}
      tabIndex={0}
      data-picture
      data-view={JSON.stringify(shownView)}
      data-frame={frame}
      data-stale={shownFrame !== null && shownFrame !== frame}
      aria-busy={shownFrame !== frame}
      {...handlers}
    >
      {width > 0 && height > 0 && (
        <Stage width={width} height={height} listening={false}>
          <Layer ref={setImageLayer} imageSmoothingEnabled={shownView.scale < SQUARE_PIXELS} listening={false}>
            {pictures}
          </Layer>
          <Layer listening={false}>
            <KeepAlive />
            {children(shownView)}
          </Layer>
          <CursorLayer pointer={pointer} view={shownView} camera={camera} label={cursorLabel} layers={layers} isMagnified={isMagnified} size={{ width, height }}>
            <KeepAlive />
            {withCursor?.(shownView)}
          </CursorLayer>
        </Stage>
      )}
      {shownFrame !== frame && pictures.length === 0 && !setback && <div className={classes.waiting} />}
      <PictureNote frame={frame} shownFrame={shownFrame} hasPicture={drawable.length > 0} setback={setback} onRetry={onRetry} isRefused={isRefused} />
      {overlay}
    </div>
  );
}
