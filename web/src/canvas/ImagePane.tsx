import { useElementSize } from "@mantine/hooks";
import type Konva from "konva";
import { useEffect, useLayoutEffect, useRef, type ReactNode } from "react";
import { Image, Layer, Rect, Stage } from "react-konva";
import type { Camera } from "../api/types";
import type { PointerStore } from "../state/pointer";
import { CursorLayer } from "./CursorLayer";
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
  /** Which frame they are of; `data-drawn` says which one is on the screen. */
  shownFrame?: number | null;
  /** Told whenever it was drawn, with the frame that is on the screen now. */
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
  isBusy: boolean;
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
  const { label, camera, layers, view, onView, brightness, contrast, pointer, cursorLabel, isMagnified, isBusy, children, withCursor, overlay, shownFrame = null, onDrawn } = props;
  const { ref: sizeRef, width, height } = useElementSize();
  const surface = useRef<HTMLDivElement | null>(null);
  const imageLayer = useRef<Konva.Layer>(null);
  const shownView = view ?? fitView(camera, { width, height });
  const mouse = usePaneGestures(surface, shownView, { width, height }, camera, onView, pointer, props);
  const handlers = useTouch(mouse, { view: shownView, isFitted: view === null, pane: { width, height }, image: camera, onView }, props);

  useEffect(() => {
    // The browser's own filter on the picture's layer costs nothing; Konva's filters would redo every pixel.
    const canvas = imageLayer.current?.getNativeCanvasElement();
    if (canvas) canvas.style.filter = brightness === 1 && contrast === 1 ? "" : `brightness(${brightness}) contrast(${contrast})`;
  });

  const meant = useRef<{ picture: Picture | null; frame: number | null; onDrawn: typeof onDrawn }>({ picture: null, frame: null, onDrawn });
  useLayoutEffect(() => {
    meant.current = { picture: layers[0]?.picture ?? null, frame: shownFrame, onDrawn };
  });
  const hasStage = width > 0 && height > 0;
  useEffect(() => {
    const layer = imageLayer.current;
    const note = (): void => {
      const { picture, frame, onDrawn: tell } = meant.current;
      const isOnScreen = picture !== null && layer?.findOne<Konva.Image>("Image")?.image() === picture;
      if (isOnScreen) tell?.(frame);
      if (surface.current && isOnScreen && surface.current.dataset["drawn"] !== String(frame)) surface.current.dataset["drawn"] = String(frame);
    };
    layer?.on("draw", note);
    // What was drawn before is noted, too.
    layer?.batchDraw();
    return () => void layer?.off("draw", note);
  }, [hasStage]);

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
      ref={(element) => {
        surface.current = element;
        sizeRef(element);
      }}
      className={classes.pane}
      role="application"
      aria-label={label}
      tabIndex={0}
      data-picture
      data-view={JSON.stringify(shownView)}
      aria-busy={isBusy}
      {...handlers}
    >
      {hasStage && (
        <Stage width={width} height={height} listening={false}>
          <Layer ref={imageLayer} imageSmoothingEnabled={shownView.scale < SQUARE_PIXELS} listening={false}>
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
      {isBusy && pictures.length === 0 && <div className={classes.waiting} />}
      {overlay}
    </div>
  );
}
