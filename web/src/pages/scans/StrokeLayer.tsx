import { useRef, useState } from "react";
import type { Point } from "../../model/crop";
import classes from "./ScanPage.module.css";

interface StrokeLayerProps {
  onBegin: () => void;
  /** The finished stroke, -1..1, x right, y up. */
  onStroke: (points: readonly Point[]) => void;
}

/** Takes one stroke of the pointer over the 3D view and shows it while it is drawn. */
export function StrokeLayer({ onBegin, onStroke }: StrokeLayerProps) {
  const [drawn, setDrawn] = useState<readonly Point[]>([]);
  const points = useRef<Point[]>([]);
  const isDrawing = useRef(false);
  const pixel = (event: React.PointerEvent<SVGSVGElement>): Point => {
    const box = event.currentTarget.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const add = (event: React.PointerEvent<SVGSVGElement>): void => {
    points.current.push(pixel(event));
    setDrawn([...points.current]);
  };
  const end = (event: React.PointerEvent<SVGSVGElement>, isMeant: boolean): void => {
    if (!isDrawing.current) return;
    isDrawing.current = false;
    const { width, height } = event.currentTarget.getBoundingClientRect();
    const stroke = points.current.map(([x, y]): Point => [(2 * x) / width - 1, 1 - (2 * y) / height]);
    points.current = [];
    setDrawn([]);
    if (isMeant) onStroke(stroke);
  };
  const path = drawn.map(([x, y], at) => `${at === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`).join(" ");
  return (
    <svg
      className={classes.strokes}
      aria-hidden
      data-testid="strokes"
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        event.currentTarget.closest<HTMLElement>("[data-picture]")?.focus({ preventScroll: true });
        isDrawing.current = true;
        onBegin();
        points.current = [];
        add(event);
      }}
      onPointerMove={(event) => isDrawing.current && add(event)}
      onPointerUp={(event) => end(event, true)}
      onPointerCancel={(event) => end(event, false)}
    >
      <path d={path} className={classes.strokeUnder} />
      <path d={path} className={classes.stroke} />
    </svg>
  );
}
