import { useComputedColorScheme } from "@mantine/core";
import { useElementSize, useMergedRef } from "@mantine/hooks";
import { useEffect, useRef } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import classes from "./Plot.module.css";
import { PlotLegend } from "./PlotLegend";
import { axesOf, breaksOf, loneOf, type Curve } from "./series";
import { useTouchSeek } from "./useTouchSeek";

interface PlotProps {
  label: string;
  /** Frames, or with `joinsAll` anything that is counted or measured. */
  frames: readonly number[];
  curves: readonly Curve[];
  /** Frames to shade. */
  lost: readonly number[];
  /** Where the line stands; null for none. */
  frame: number | null;
  /** Without it a click does nothing. */
  onSeek?: (frame: number) => void;
  /** The left axis by powers of ten; what is not above zero is left out. */
  isLog?: boolean;
  /** Lines join whatever follows; without it only neighbouring frames, for between others nothing was measured. */
  joinsAll?: boolean;
  /** A plot with two axes is above it: the frames of both stand under one another. */
  isBelowTwoAxes?: boolean;
  /** Names and values of the curves; off where another plot beside this one has them. */
  hasLegend?: boolean;
}

/** Only the powers of ten themselves get a line and a number. */
const onlyDecades: uPlot.Axis.Filter = (_, splits) => splits.map((split) => (Math.abs(Math.log10(split) % 1) < 1e-6 ? split : null));

/** Frames and iterations are counted. */
const WHOLE = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000, 100_000];

/** Of the numbers at an axis and of what they measure, px. */
const AXIS_SIZE = 44;
const TITLE_SIZE = 16;

const compact = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

/** The powers of ten around positive values. */
const decades = (low: number | null, high: number | null): [number, number] => {
  const from = Math.floor(Math.log10(low !== null && low > 0 ? low : 1));
  const to = Math.ceil(Math.log10(high !== null && high > 0 ? high : 10));
  return [10 ** from, 10 ** Math.max(to, from + 1)];
};

/** Curves over the frames, or over anything counted; a click goes to the frame, the line shows where one is. */
export function Plot({ label, frames, curves, lost, frame, onSeek, isLog = false, joinsAll = false, isBelowTwoAxes = false, hasLegend = true }: PlotProps) {
  const { ref: sizeRef, width, height } = useElementSize();
  const holder = useRef<HTMLDivElement | null>(null);
  const held = useMergedRef(holder, sizeRef);
  const plot = useRef<uPlot | null>(null);
  const here = useRef(frame);
  const seek = useRef(onSeek);
  const scheme = useComputedColorScheme("dark");
  here.current = frame;
  seek.current = onSeek;

  useEffect(() => {
    const element = holder.current;
    if (!element || width === 0 || height < 40) return;
    const style = getComputedStyle(element);
    const [ink, line, bad] = ["--text-quiet", "--line", "--bad"].map((name) => style.getPropertyValue(name)) as [string, string, string];
    const strong = style.getPropertyValue("--mantine-color-text");
    const font = "11px Inter Variable, sans-serif";
    const [left, right] = axesOf(curves);
    const axisOf = (side: "left" | "right", title: string | undefined): uPlot.Axis => ({
      scale: side,
      side: side === "left" ? 3 : 1,
      label: title,
      labelFont: font,
      labelSize: TITLE_SIZE,
      labelGap: 0,
      stroke: ink,
      font,
      size: AXIS_SIZE,
      values: (_, splits) => splits.map((split) => (split === null ? "" : compact.format(split))),
      ticks: { show: false },
      grid: { show: side === "left", stroke: line, width: 1, ...(isLog ? { filter: onlyDecades } : {}) },
      ...(isLog && side === "left" ? { filter: onlyDecades } : {}),
    });
    const hasRight = right !== undefined;
    const breaks = curves.map((curve) => (joinsAll ? [] : breaksOf(frames, curve.values)));
    const lone = curves.map((curve) => (joinsAll ? [] : loneOf(frames, curve.values)));
    const made = new uPlot(
      {
        width,
        height,
        padding: [8, hasRight ? 0 : isBelowTwoAxes ? AXIS_SIZE + TITLE_SIZE : 12, 0, 0],
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { size: 6 }, y: false },
        scales: {
          x: { time: false },
          left: isLog
            ? { distr: 3, log: 10, range: (_, low, high) => decades(low, high) }
            : { range: (_, low, high) => [Math.min(0, low ?? 0), high === null || high <= 0 ? 1 : high * 1.08] },
          right: { range: (_, low, high) => [Math.min(0, low ?? 0), high === null || high <= 0 ? 1 : high * 1.08] },
        },
        axes: [
          { stroke: ink, font, size: 26, incrs: WHOLE, ticks: { show: false }, grid: { show: false } },
          axisOf("left", left),
          ...(hasRight ? [axisOf("right", right)] : []),
        ],
        series: [
          {},
          ...curves.map((curve, place) => ({
            label: curve.label,
            scale: curve.axis === left ? "left" : "right",
            stroke: curve.color,
            width: 1.5,
            ...(curve.dash ? { dash: curve.dash } : {}),
            points: { show: true, size: curve.isSparse ? 6 : 5, fill: curve.color, filter: () => (curve.isSparse || curve.hasDots ? null : (lone[place] ?? [])) },
            gaps: (drawn: uPlot, _place: number, _from: number, _to: number, found: uPlot.Series.Gaps) =>
              joinsAll ? found : (breaks[place] ?? []).map((ends): [number, number] => [drawn.valToPos(frames[ends[0]] ?? 0, "x", true), drawn.valToPos(frames[ends[1]] ?? 0, "x", true)]),
            ...(curve.isSparse ? { paths: () => null } : {}),
          })),
        ],
        hooks: {
          drawClear: [
            (drawn) => {
              const { ctx, bbox } = drawn;
              ctx.save();
              ctx.fillStyle = bad;
              ctx.globalAlpha = 0.25;
              for (const at of lost) {
                const [from, to] = [drawn.valToPos(at - 0.5, "x", true), drawn.valToPos(at + 0.5, "x", true)];
                ctx.fillRect(from, bbox.top, Math.max(1, to - from), bbox.height);
              }
              ctx.restore();
            },
          ],
          draw: [
            (drawn) => {
              if (here.current === null) return;
              const { ctx, bbox } = drawn;
              const x = Math.round(drawn.valToPos(here.current, "x", true));
              ctx.save();
              ctx.strokeStyle = strong;
              ctx.setLineDash([]);
              ctx.lineWidth = Math.max(1, window.devicePixelRatio);
              ctx.beginPath();
              ctx.moveTo(x, bbox.top);
              ctx.lineTo(x, bbox.top + bbox.height);
              ctx.stroke();
              ctx.restore();
            },
          ],
          ready: [
            (drawn) =>
              drawn.over.addEventListener("click", () => {
                const at = drawn.cursor.idx;
                const chosen = at === null || at === undefined ? undefined : drawn.data[0][at];
                if (chosen !== undefined) seek.current?.(chosen);
              }),
          ],
        },
      },
      [
        frames as number[],
        ...curves.map((curve) => (isLog && curve.axis === left ? curve.values.map((value) => (value !== null && value > 0 ? value : null)) : curve.values) as (number | null)[]),
      ],
      element,
    );
    plot.current = made;
    return () => {
      plot.current = null;
      made.destroy();
    };
  }, [width, height, frames, curves, lost, scheme, isLog, joinsAll, isBelowTwoAxes]);

  useEffect(() => plot.current?.redraw(false), [frame]);
  useTouchSeek(holder, plot, seek);

  const index = frame === null ? -1 : frames.indexOf(frame);
  return (
    <figure className={classes.figure} aria-label={label} data-seeks={onSeek !== undefined}>
      {hasLegend && <PlotLegend curves={curves} index={index} />}
      <div ref={held} className={classes.holder} />
    </figure>
  );
}
