import { useEffect, useRef, type MouseEvent as ReactMouseEvent, type PointerEvent as ReactPointerEvent, type RefObject } from "react";
import type { PointerStore } from "../state/pointer";
import { fitView, isInImage, panBy, toPixel, zoomAt, type Point, type Size, type View } from "./view";

/** What a pane does with gestures on its image; all points are image pixels. Without them a pane only zooms and pans. */
export interface PaneGestures {
  /** The joint under a screen point, or -1. */
  hitJoint?: (view: View, screen: Point) => number;
  onPlace?: (pixel: Point) => void;
  onSelect?: (joint: number) => void;
  onDragJoint?: (joint: number, to: Point) => void;
  onDragHand?: (by: Point) => void;
  /** While the wheel turns with Alt: radians and a factor since it began, about where the cursor was then. */
  onTurnHand?: (turn: { about: Point; angle: number; factor: number }) => void;
  onDragEnd?: () => void;
  onCycle?: (joint: number) => void;
  /** A double click; whether it meant something. */
  onDouble?: (view: View, screen: Point) => boolean;
  /** Space is held for panning, so it was not meant for playing. */
  onSpacePan?: () => void;
}

type Press =
  | { kind: "pan"; last: Point }
  | { kind: "ground"; start: Point; last: Point }
  | { kind: "joint"; joint: number; start: Point; isMoving: boolean }
  | { kind: "hand"; start: Point };

/** How far a press may wander and still be a click, px of the screen. */
const CLICK_RADIUS = 4;

/** One notch of a wheel (100) turns by 2 degrees or grows by 2 %. */
const TURN_PER_STEP = (2 * Math.PI) / 180 / 100;
const GROWTH_PER_STEP = Math.log(1.02) / 100;
/** A pause this long ends a turn: the next notch is another step for undo. */
const TURN_PAUSE_MS = 700;

const clamp = (pixel: Point, image: Size): Point => ({
  x: Math.min(image.width - 0.501, Math.max(-0.5, pixel.x)),
  y: Math.min(image.height - 0.501, Math.max(-0.5, pixel.y)),
});

export function usePaneGestures(
  surface: RefObject<HTMLElement | null>,
  view: View,
  pane: Size,
  image: Size,
  onView: (view: View | null) => void,
  pointer: PointerStore,
  gestures: PaneGestures,
) {
  const press = useRef<Press | null>(null);
  const latest = useRef({ view, pane, image, onView, gestures });
  latest.current = { view, pane, image, onView, gestures };

  useEffect(() => {
    const element = surface.current;
    if (!element) return;
    let turn: { about: Point; angle: number; factor: number } | null = null;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const endTurn = (): void => {
      clearTimeout(timer);
      if (turn) latest.current.gestures.onDragEnd?.();
      turn = null;
    };
    // React listens passively to the wheel; the page must not scroll.
    const wheel = (event: WheelEvent): void => {
      event.preventDefault();
      const now = latest.current;
      const box = element.getBoundingClientRect();
      const screen = { x: event.clientX - box.left, y: event.clientY - box.top };
      // With Shift a browser turns a wheel sideways.
      const by = (event.deltaY || event.deltaX) * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1);
      if (event.altKey && now.gestures.onTurnHand) {
        turn ??= { about: toPixel(now.view, screen), angle: 0, factor: 1 };
        turn = event.shiftKey ? { ...turn, factor: turn.factor * Math.exp(-by * GROWTH_PER_STEP) } : { ...turn, angle: turn.angle + by * TURN_PER_STEP };
        now.gestures.onTurnHand(turn);
        clearTimeout(timer);
        timer = setTimeout(endTurn, TURN_PAUSE_MS);
        return;
      }
      const smallest = fitView(now.image, now.pane).scale * 0.5;
      now.onView(zoomAt(now.view, screen, Math.exp(-by * 0.0015), smallest));
    };
    // Whatever comes next finds the turn done.
    const next = (event: Event): void => {
      if (!(event instanceof KeyboardEvent && ["Alt", "Shift"].includes(event.key))) endTurn();
    };
    element.addEventListener("wheel", wheel, { passive: false });
    window.addEventListener("keydown", next, true);
    window.addEventListener("pointerdown", next, true);
    return () => {
      endTurn();
      element.removeEventListener("wheel", wheel);
      window.removeEventListener("keydown", next, true);
      window.removeEventListener("pointerdown", next, true);
    };
  }, [surface]);

  const isSpaceHeld = useRef(false);
  useEffect(() => {
    const note = (event: KeyboardEvent): void => {
      if (event.code === "Space") isSpaceHeld.current = event.type === "keydown";
    };
    window.addEventListener("keydown", note);
    window.addEventListener("keyup", note);
    return () => {
      window.removeEventListener("keydown", note);
      window.removeEventListener("keyup", note);
    };
  }, []);

  const screenOf = (event: ReactPointerEvent): Point => {
    const box = event.currentTarget.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const isOwn = (event: ReactPointerEvent): boolean => !(event.target as Element).closest("[data-over-picture]");
  const far = (a: Point, b: Point): boolean => Math.hypot(a.x - b.x, a.y - b.y) > CLICK_RADIUS;

  return {
    onContextMenu: (event: { preventDefault(): void }) => event.preventDefault(),

    onPointerDown(event: ReactPointerEvent<HTMLElement>) {
      if (!isOwn(event)) return;
      event.currentTarget.focus({ preventScroll: true });
      const screen = screenOf(event);
      const pixel = toPixel(view, screen);
      const joint = gestures.hitJoint?.(view, screen) ?? -1;
      if (event.button === 2) {
        if (joint >= 0) gestures.onCycle?.(joint);
        return;
      }
      event.currentTarget.setPointerCapture(event.pointerId);
      if (isSpaceHeld.current) gestures.onSpacePan?.();
      if (event.button === 1 || event.ctrlKey || event.metaKey || isSpaceHeld.current) press.current = { kind: "pan", last: screen };
      else if (event.altKey && gestures.onDragHand) press.current = { kind: "hand", start: pixel };
      else if (joint >= 0) press.current = { kind: "joint", joint, start: screen, isMoving: false };
      else press.current = { kind: "ground", start: screen, last: screen };
    },

    onPointerMove(event: ReactPointerEvent<HTMLElement>) {
      const screen = screenOf(event);
      const pixel = toPixel(view, screen);
      pointer.set(isInImage(pixel, image) && isOwn(event) ? pixel : null, "person");
      const now = press.current;
      switch (now?.kind) {
        case "pan":
          onView(panBy(view, { x: screen.x - now.last.x, y: screen.y - now.last.y }, image, pane));
          press.current = { kind: "pan", last: screen };
          return;
        case "ground":
          if (far(now.start, screen)) press.current = { kind: "pan", last: screen };
          return;
        case "joint":
          if (!now.isMoving && far(now.start, screen)) now.isMoving = true;
          if (now.isMoving) gestures.onDragJoint?.(now.joint, clamp(pixel, image));
          return;
        case "hand":
          gestures.onDragHand?.({ x: pixel.x - now.start.x, y: pixel.y - now.start.y });
          return;
      }
    },

    onPointerUp(event: ReactPointerEvent<HTMLElement>) {
      const now = press.current;
      press.current = null;
      if (now?.kind === "ground") {
        const pixel = toPixel(view, screenOf(event));
        if (isInImage(pixel, image)) gestures.onPlace?.(pixel);
      } else if (now?.kind === "joint" && !now.isMoving) gestures.onSelect?.(now.joint);
      else if (now?.kind === "joint" || now?.kind === "hand") gestures.onDragEnd?.();
    },

    onPointerCancel() {
      press.current = null;
      gestures.onDragEnd?.();
    },

    onDoubleClick(event: ReactMouseEvent<HTMLElement>) {
      const box = event.currentTarget.getBoundingClientRect();
      const screen = { x: event.clientX - box.left, y: event.clientY - box.top };
      if (gestures.onDouble?.(view, screen)) return;
      if (!isInImage(toPixel(view, screen), image)) onView(null);
    },

    onPointerLeave() {
      pointer.set(null, "person");
    },
  };
}
