import { useComputedColorScheme } from "@mantine/core";
import { useElementSize, useMergedRef } from "@mantine/hooks";
import { useEffect, useRef, useState, type KeyboardEvent, type PointerEvent } from "react";
import { drawTimeline, lanesOf, type TimelineContent } from "./drawTimeline";
import { frameAt, panWindow, xOf, zoomWindow, type FrameWindow } from "./frameWindow";
import classes from "./TimelineStrip.module.css";

interface TimelineStripProps {
  content: TimelineContent;
  frame: number;
  window: FrameWindow;
  onWindow: (window: FrameWindow) => void;
  onSeek: (frame: number) => void;
  /** What to say of a frame under the pointer, line by line. */
  describe: (frame: number) => readonly string[];
}

/** Every frame of a recording; drag scrubs, the wheel zooms, Shift and the wheel pan, arrow keys step. */
export function TimelineStrip({ content, frame, window: shown, onWindow, onSeek, describe }: TimelineStripProps) {
  const { ref, width } = useElementSize();
  const canvas = useRef<HTMLCanvasElement>(null);
  const surface = useRef<HTMLDivElement | null>(null);
  const held = useMergedRef(surface, ref);
  const scheme = useComputedColorScheme("dark");
  const [hovered, setHovered] = useState<number | null>(null);
  const { frameCount } = content;
  const { height, axis } = lanesOf(content);

  useEffect(() => {
    const element = canvas.current;
    const context = element?.getContext("2d");
    if (!element || !context || width === 0) return;
    const ratio = window.devicePixelRatio || 1;
    element.width = Math.round(width * ratio);
    element.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const style = getComputedStyle(element);
    const color = (name: string): string => style.getPropertyValue(name);
    drawTimeline(
      context,
      content,
      { window: shown, width },
      {
        ground: color("--surface-sunken"),
        text: color("--mantine-color-text"),
        quiet: color("--text-quiet"),
        suggestion: color("--suggestion"),
        bad: color("--bad"),
        accent: color("--mantine-color-teal-5"),
      },
    );
  }, [content, shown, width, height, scheme]);

  const latest = useRef({ shown, onWindow, frameCount });
  latest.current = { shown, onWindow, frameCount };
  useEffect(() => {
    const element = surface.current;
    if (!element) return;
    const wheel = (event: WheelEvent): void => {
      event.preventDefault();
      const now = latest.current;
      const box = element.getBoundingClientRect();
      const by = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        now.onWindow(panWindow(now.shown, (((event.deltaX || event.deltaY) * by) / 800) * now.shown.count, now.frameCount));
      } else {
        now.onWindow(zoomWindow(now.shown, Math.exp(-event.deltaY * by * 0.002), (event.clientX - box.left) / box.width, now.frameCount));
      }
    };
    element.addEventListener("wheel", wheel, { passive: false });
    return () => element.removeEventListener("wheel", wheel);
  }, []);

  const frameOf = (event: PointerEvent): number => {
    const box = event.currentTarget.getBoundingClientRect();
    return frameAt(shown, box.width, event.clientX - box.left, frameCount);
  };
  const key = (event: KeyboardEvent): void => {
    const steps: Record<string, number> = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 };
    const next = event.key === "Home" ? 0 : event.key === "End" ? frameCount - 1 : frame + (steps[event.key] ?? Number.NaN);
    if (Number.isNaN(next)) return;
    event.preventDefault();
    event.stopPropagation();
    onSeek(Math.min(frameCount - 1, Math.max(0, next)));
  };
  const at = xOf(shown, width, frame);
  const step = width / shown.count;

  return (
    <div
      ref={held}
      className={classes.strip}
      style={{ height }}
      role="slider"
      tabIndex={0}
      aria-label="Timeline"
      aria-valuemin={0}
      aria-valuemax={Math.max(0, frameCount - 1)}
      aria-valuenow={frame}
      aria-valuetext={`Frame ${frame}: ${describe(frame).join("; ")}`}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        onSeek(frameOf(event));
      }}
      onPointerMove={(event) => {
        const under = frameOf(event);
        setHovered(under);
        if (event.buttons === 1) onSeek(under);
      }}
      onPointerLeave={() => setHovered(null)}
      onKeyDown={key}
    >
      <canvas ref={canvas} style={{ width: "100%", height }} />
      {width > 0 && at > -step && at < width && (
        <div className={classes.cursor} style={{ transform: `translateX(${at}px)`, width: Math.max(2, step), height: axis }}>
          <span />
        </div>
      )}
      {hovered !== null && width > 0 && (
        <div className={classes.hint} style={{ left: Math.min(width - 90, Math.max(90, xOf(shown, width, hovered + 0.5))) }}>
          <b>frame {hovered}</b>
          {describe(hovered).map((line) => (
            <span key={line}>{line}</span>
          ))}
        </div>
      )}
    </div>
  );
}
