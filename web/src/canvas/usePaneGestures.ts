import { useEffect, useRef, type MouseEvent as ReactMouseEvent, type PointerEvent as ReactPointerEvent, type RefObject } from "react";
import type { PointerStore } from "../state/pointer";
import { fitView, isInImage, panBy, toPixel, zoomAt, type Point, type Size, type View } from "./view";

/** What a pane does with gestures on its image; all points are image pixels. Without them a pane only zooms and pans. */
export interface PaneGestures {
  /** The joint under a screen point, or -1. */
  hitJoint?: (view: View, screen: Point) => number;
  /** The joint that a click there chooses, or -1 for one that places. A press that becomes a drag goes by `hitJoint`. */
  chosenAt?: (view: View, screen: Point) => number;
  onPlace?: (pixel: Point) => void;
  onSelect?: (joint: number) => void;
  onDragJoint?: (joint: number, to: Point) => void;
  onDragHand?: (by: Point) => void;
  /** While the wheel turns with Alt: radians and a factor since it began, about where the cursor was then. */
  onTurnHand?: (turn: { about: Point; angle: number; factor: number }) => void;
  onDragEnd?: () => void;
  onDragCancel?: () => void;
  /** Whether what was dragged or turned still hangs on the pointer; no longer, once somebody went to another frame or called it off. */
  isDragOn?: () => boolean;
  onCycle?: (joint: number) => void;
  /** A double click; whether it meant something. */
  onDouble?: (view: View, screen: Point) => boolean;
  /** A press that would change something came while the picture is not the wanted one. */
  onRefused?: () => void;
  /** Space is held for panning, so it was not meant for playing. */
  onSpacePan?: () => void;
}

/** `on` is the frame that was on the screen when it began. */
type Press =
  | { kind: "pan"; last: Point }
  | { kind: "ground"; start: Point; on: number | null }
  | { kind: "joint"; joint: number; start: Point; on: number; isMoving: boolean }
  | { kind: "hand"; start: Point; on: number; isMoving: boolean };

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

/** `live` says which frame is on the screen, null while it is not the wanted one: then a pane only zooms and pans. */
export function usePaneGestures(
  surface: RefObject<HTMLElement | null>,
  view: View,
  pane: Size,
  image: Size,
  onView: (view: View | null) => void,
  pointer: PointerStore,
  live: () => number | null,
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
        if (live() === null) return now.gestures.onRefused?.();
        if (turn && !now.gestures.isDragOn?.()) turn = null;
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
  }, [surface, live]);

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
    onContextMenu: (event: { preventDefault: () => void }) => event.preventDefault(),

    onPointerDown(event: ReactPointerEvent<HTMLElement>) {
      if (!isOwn(event)) return;
      event.currentTarget.focus({ preventScroll: true });
      const screen = screenOf(event);
      const pixel = toPixel(view, screen);
      const on = live();
      const joint = on === null ? -1 : (gestures.hitJoint?.(view, screen) ?? -1);
      if (event.button === 2) {
        if (on === null) gestures.onRefused?.();
        else if (joint >= 0) gestures.onCycle?.(joint);
        return;
      }
      event.currentTarget.setPointerCapture(event.pointerId);
      if (isSpaceHeld.current) gestures.onSpacePan?.();
      if (event.button === 1 || event.ctrlKey || event.metaKey || isSpaceHeld.current) press.current = { kind: "pan", last: screen };
      else if (event.altKey && gestures.onDragHand && on !== null) press.current = { kind: "hand", start: pixel, on, isMoving: false };
      else if (joint >= 0 && on !== null && !event.shiftKey) press.current = { kind: "joint", joint, start: screen, on, isMoving: false };
      else press.current = { kind: "ground", start: screen, on };
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
        case "hand": {
          if (now.kind === "joint" && !now.isMoving && !far(now.start, screen)) return;
          // A drag that began on one picture does not go on upon another.
          if (now.isMoving ? !gestures.isDragOn?.() : live() !== now.on) {
            press.current = null;
            return;
          }
          now.isMoving = true;
          if (now.kind === "joint") gestures.onDragJoint?.(now.joint, clamp(pixel, image));
          else gestures.onDragHand?.({ x: pixel.x - now.start.x, y: pixel.y - now.start.y });
          return;
        }
      }
    },

    onPointerUp(event: ReactPointerEvent<HTMLElement>) {
      const now = press.current;
      press.current = null;
      if (!now || now.kind === "pan") return;
      if (now.kind !== "ground" && now.isMoving) return gestures.onDragEnd?.();
      const pixel = toPixel(view, screenOf(event));
      if (now.on === null || live() !== now.on) {
        if (isInImage(pixel, image)) gestures.onRefused?.();
        return;
      }
      const chosen = now.kind === "joint" ? (gestures.chosenAt?.(view, now.start) ?? now.joint) : -1;
      if (chosen >= 0) gestures.onSelect?.(chosen);
      else if (now.kind !== "hand" && isInImage(pixel, image)) gestures.onPlace?.(pixel);
    },

    onPointerCancel() {
      press.current = null;
      gestures.onDragCancel?.();
    },

    onDoubleClick(event: ReactMouseEvent<HTMLElement>) {
      const box = event.currentTarget.getBoundingClientRect();
      const screen = { x: event.clientX - box.left, y: event.clientY - box.top };
      if (live() !== null && gestures.onDouble?.(view, screen)) return;
      if (!isInImage(toPixel(view, screen), image)) onView(null);
    },

    onPointerLeave() {
      pointer.set(null, "person");
    },
  };
}
