import { useRef, type MouseEvent as ReactMouseEvent, type PointerEvent as ReactPointerEvent } from "react";
import { pinch, swipeOf } from "./pinch";
import type { PaneGestures } from "./usePaneGestures";
import { fitView, panBy, zoomAt, type Point, type Size, type View } from "./view";

/** What fingers do on a picture, beside what they share with the mouse. */
export interface TouchGestures {
  /** One finger only looks: it goes through the frames, pans and chooses joints, but places and drags nothing. */
  isTouchLooking?: boolean;
  /** A finger drawn across a picture that fits its pane: 1 to the next frame, -1 to the one before. */
  onSwipe?: (by: 1 | -1) => void;
}

interface Handlers {
  onPointerDown: (event: ReactPointerEvent<HTMLElement>) => void;
  onPointerMove: (event: ReactPointerEvent<HTMLElement>) => void;
  onPointerUp: (event: ReactPointerEvent<HTMLElement>) => void;
  onPointerCancel: (event: ReactPointerEvent<HTMLElement>) => void;
  onDoubleClick: (event: ReactMouseEvent<HTMLElement>) => void;
}

interface Place {
  /** As it is drawn; `isFitted` when nobody has zoomed. */
  view: View;
  isFitted: boolean;
  pane: Size;
  image: Size;
  onView: (view: View | null) => void;
}

/** A finger may wander this far and still tap, px of the screen. */
const TAP_RADIUS = 10;

const CLOSER = 2.5;

/** Puts fingers before the handlers of a pane: two of them zoom, one of them looks or does what the mouse does. */
export function useTouch<Own extends Handlers>(own: Own, place: Place, gestures: PaneGestures & TouchGestures): Own {
  const fingers = useRef(new Map<number, Point>());
  const start = useRef<Point | null>(null);
  const isTouch = useRef(false);
  // Fingers move more often than React draws.
  const now = useRef(place);
  now.current = place;
  const change = (view: View | null): void => {
    const { image, pane, onView } = now.current;
    now.current = { ...now.current, view: view ?? fitView(image, pane), isFitted: view === null };
    onView(view);
  };
  const screenOf = (event: ReactPointerEvent | ReactMouseEvent): Point => {
    const box = event.currentTarget.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const looks = gestures.isTouchLooking === true;
  const isOver = (event: ReactPointerEvent): boolean => (event.target as Element).closest("[data-over-picture], button, a, input, label") !== null;

  const lift = (event: ReactPointerEvent<HTMLElement>, isMeant: boolean): void => {
    const point = screenOf(event);
    const from = start.current;
    const wasAlone = fingers.current.size === 1;
    fingers.current.delete(event.pointerId);
    if (fingers.current.size === 0) start.current = null;
    if (!from || !wasAlone || !looks || !isMeant) return;
    const by = swipeOf(from, point);
    if (by !== 0 && now.current.isFitted) gestures.onSwipe?.(by);
    else if (Math.hypot(point.x - from.x, point.y - from.y) <= TAP_RADIUS) {
      const joint = gestures.hitJoint?.(now.current.view, point) ?? -1;
      if (joint >= 0) gestures.onSelect?.(joint);
    }
  };

  return {
    ...own,
    onPointerDown(event) {
      isTouch.current = event.pointerType === "touch";
      if (!isTouch.current || isOver(event)) return own.onPointerDown(event);
      const point = screenOf(event);
      fingers.current.set(event.pointerId, point);
      event.currentTarget.setPointerCapture(event.pointerId);
      if (fingers.current.size === 1) {
        start.current = point;
        if (!looks) own.onPointerDown(event);
        return;
      }
      // The first finger was the beginning of this, and neither places nor drags anything.
      start.current = null;
      if (!looks) own.onPointerCancel(event);
    },

    onPointerMove(event) {
      const before = fingers.current.get(event.pointerId);
      if (!before) return own.onPointerMove(event);
      const point = screenOf(event);
      const { view, image, pane } = now.current;
      const other = [...fingers.current].find(([id]) => id !== event.pointerId)?.[1];
      fingers.current.set(event.pointerId, point);
      if (other) return change(pinch(view, [before, other], [point, other], image, pane));
      if (!start.current) return;
      if (!looks) own.onPointerMove(event);
      else if (!now.current.isFitted) change(panBy(view, { x: point.x - before.x, y: point.y - before.y }, image, pane));
    },

    onPointerUp(event) {
      if (!fingers.current.has(event.pointerId)) return own.onPointerUp(event);
      const isAlone = start.current !== null && fingers.current.size === 1;
      lift(event, true);
      if (isAlone && !looks) own.onPointerUp(event);
    },

    onPointerCancel(event) {
      if (!fingers.current.has(event.pointerId)) return own.onPointerCancel(event);
      lift(event, false);
      if (!looks) own.onPointerCancel(event);
    },

    onDoubleClick(event) {
      if (!isTouch.current || !looks) return own.onDoubleClick(event);
      const { view, isFitted } = now.current;
      change(isFitted ? zoomAt(view, screenOf(event), CLOSER, 0) : null);
    },
  };
}
