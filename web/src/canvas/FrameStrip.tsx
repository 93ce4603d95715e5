import { useComputedColorScheme } from "@mantine/core";
import { useElementSize } from "@mantine/hooks";
import { useEffect, useRef, useState, type KeyboardEvent, type PointerEvent } from "react";
import { drawStrip, frameAtX, type StripRow } from "./strip";
import classes from "./FrameStrip.module.css";

interface FrameStripProps {
  rows: readonly StripRow[];
  frameCount: number;
  frame: number | null;
  height: number;
  label: string;
  onSeek: (frame: number) => void;
  /** What to say about a frame under the pointer. */
  describe?: (frame: number) => string;
}

/** The frames of a recording as a strip; click, drag or arrow keys choose one. */
export function FrameStrip({ rows, frameCount, frame, height, label, onSeek, describe }: FrameStripProps) {
  const { ref, width } = useElementSize();
  const canvas = useRef<HTMLCanvasElement>(null);
  const scheme = useComputedColorScheme("dark");
  const [hovered, setHovered] = useState<number | null>(null);

  useEffect(() => {
    const element = canvas.current;
    const context = element?.getContext("2d");
    if (!element || !context || width === 0) return;
    const ratio = window.devicePixelRatio || 1;
    element.width = Math.round(width * ratio);
    element.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const style = getComputedStyle(element);
    const ground = style.getPropertyValue("--surface-sunken");
    const cursor = style.getPropertyValue("--mantine-color-text");
    drawStrip(context, rows, frame, frameCount, { width, height }, { ground, cursor });
  }, [rows, frame, frameCount, width, height, scheme]);

  const frameOf = (event: PointerEvent): number => {
    const box = event.currentTarget.getBoundingClientRect();
    return frameAtX(event.clientX - box.left, box.width, frameCount);
  };
  const press = (event: PointerEvent): void => {
    event.currentTarget.setPointerCapture(event.pointerId);
    onSeek(frameOf(event));
  };
  const move = (event: PointerEvent): void => {
    const at = frameOf(event);
    setHovered(at);
    if (event.buttons === 1) onSeek(at);
  };
  const key = (event: KeyboardEvent): void => {
    const steps: Record<string, number> = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 };
    const at = frame ?? 0;
    const next = event.key === "Home" ? 0 : event.key === "End" ? frameCount - 1 : at + (steps[event.key] ?? 0);
    if (event.key !== "Home" && event.key !== "End" && steps[event.key] === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    onSeek(Math.min(frameCount - 1, Math.max(0, next)));
  };

  return (
    <div
      ref={ref}
      className={classes.strip}
      style={{ height }}
      role="slider"
      tabIndex={0}
      aria-label={label}
      aria-valuemin={0}
      aria-valuemax={Math.max(0, frameCount - 1)}
      aria-valuenow={frame ?? 0}
      onPointerDown={press}
      onPointerMove={move}
      onPointerLeave={() => setHovered(null)}
      onKeyDown={key}
    >
      <canvas ref={canvas} style={{ width: "100%", height }} />
      {hovered !== null && width > 0 && (
        <div className={classes.hint} style={{ left: Math.min(width - 60, Math.max(60, ((hovered + 0.5) / frameCount) * width)) }}>
          {describe ? describe(hovered) : `frame ${hovered}`}
        </div>
      )}
    </div>
  );
}
