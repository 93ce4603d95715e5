/** A timeline on a canvas: rows of hands, marks, a track's rows and frame numbers. Pure drawing, told apart by shape as well as colour. */

import type { FrameMark } from "../model/frameMarks";
import { progressOf, type HandFrames } from "../model/frameStates";
import { HAND_COLORS, JOINT_COUNT } from "../model/joints";
import { tickStep, xOf, type FrameWindow } from "./frameWindow";
import type { StripRow } from "./strip";

export interface TimelineColors {
  readonly ground: string;
  readonly text: string;
  readonly quiet: string;
  readonly suggestion: string;
  readonly bad: string;
  readonly accent: string;
}

export interface TimelineContent {
  readonly hands: readonly HandFrames[];
  readonly rows: readonly StripRow[];
  readonly marks: Readonly<Record<FrameMark, ReadonlySet<number>>>;
  readonly frameCount: number;
  /** The only frames that are asked for; null for all. */
  readonly asked: ReadonlySet<number> | null;
}

const LANE = { marks: 9, hand: 12, gap: 2, row: 9, submitted: 4, axis: 14 } as const;

export interface Lane {
  readonly label: string;
  readonly top: number;
  readonly height: number;
}

/** Where each row lies, px from the top, with the height of everything last. */
export function lanesOf(content: TimelineContent): { lanes: Lane[]; submitted: number; axis: number; height: number } {
  let top: number = LANE.marks;
  const lanes: Lane[] = [];
  for (const { hand } of content.hands) {
    lanes.push({ label: hand, top, height: LANE.hand });
    top += LANE.hand + LANE.gap;
  }
  for (const { label } of content.rows) {
    lanes.push({ label, top, height: LANE.row });
    top += LANE.row + LANE.gap;
  }
  const submitted = top;
  return { lanes, submitted, axis: submitted + LANE.submitted, height: submitted + LANE.submitted + LANE.axis };
}

interface Place {
  readonly window: FrameWindow;
  readonly width: number;
}

/** Pixel columns of a frame: at least one wide, with a gap between frames where there is room for it. */
function spanOf({ window, width }: Place, frame: number): { x: number; w: number; middle: number } {
  const x = xOf(window, width, frame);
  const step = width / window.count;
  return { x: Math.floor(x), w: Math.max(1, step >= 5 ? step - 1 : Math.ceil(step)), middle: x + step / 2 };
}

function drawHand(context: CanvasRenderingContext2D, place: Place, row: HandFrames, lane: Lane, colors: TimelineColors, shown: readonly number[]): void {
  const color = HAND_COLORS[row.hand];
  for (const frame of shown) {
    const decided = row.decided[frame] ?? 0;
    const progress = progressOf(decided);
    if (progress === "none") continue;
    const { x, w } = spanOf(place, frame);
    const height = progress === "complete" ? lane.height : Math.max(3, Math.round((0.75 * lane.height * decided) / JOINT_COUNT));
    context.globalAlpha = progress === "complete" ? 1 : 0.65;
    context.fillStyle = color;
    context.fillRect(x, lane.top + lane.height - height, w, height);
  }
  context.globalAlpha = 1;
  context.strokeStyle = colors.suggestion;
  context.lineWidth = 3;
  context.setLineDash([4, 2]);
  runs(shown, row.suggested).forEach(([first, last]) => {
    context.beginPath();
    context.moveTo(spanOf(place, first).x, lane.top + 3);
    context.lineTo(Math.max(spanOf(place, first).x + 4, spanOf(place, last).x + spanOf(place, last).w), lane.top + 3);
    context.stroke();
  });
  context.setLineDash([]);
  for (const frame of shown) {
    if (!row.key.has(frame)) continue;
    const { middle } = spanOf(place, frame);
    const centre = lane.top + lane.height / 2;
    context.beginPath();
    context.moveTo(middle, centre - 5.5);
    context.lineTo(middle + 5.5, centre);
    context.lineTo(middle, centre + 5.5);
    context.lineTo(middle - 5.5, centre);
    context.closePath();
    context.fillStyle = "#fff";
    context.strokeStyle = "#111";
    context.lineWidth = 1.5;
    context.fill();
    context.stroke();
  }
}

/** Runs of neighbouring frames that are in a set. */
function runs(shown: readonly number[], wanted: ReadonlySet<number>): [number, number][] {
  const found: [number, number][] = [];
  for (const frame of shown) {
    if (!wanted.has(frame)) continue;
    const last = found.at(-1);
    if (last && last[1] === frame - 1) last[1] = frame;
    else found.push([frame, frame]);
  }
  return found;
}

export function drawTimeline(context: CanvasRenderingContext2D, content: TimelineContent, place: Place, colors: TimelineColors): void {
  const { lanes, submitted, axis, height } = lanesOf(content);
  const { window, width } = place;
  context.clearRect(0, 0, width, height);
  const first = Math.floor(window.from);
  const shown = Array.from({ length: Math.min(content.frameCount, Math.ceil(window.from + window.count)) - first }, (_, index) => first + index);

  context.fillStyle = colors.ground;
  for (const lane of lanes) context.fillRect(0, lane.top, width, lane.height);
  content.hands.forEach((row, index) => {
    const lane = lanes[index];
    if (lane) drawHand(context, place, row, lane, colors, shown);
  });
  content.rows.forEach((row, index) => {
    const lane = lanes[content.hands.length + index];
    if (!lane) return;
    for (const frame of shown) {
      const value = row.values[frame] ?? 0;
      if (value <= 0) continue;
      const { x, w } = spanOf(place, frame);
      context.fillStyle = typeof row.color === "string" ? row.color : row.color(value);
      context.fillRect(x, lane.top + lane.height * (1 - value), w, lane.height * value);
    }
  });

  context.fillStyle = colors.bad;
  for (const frame of shown) {
    if (!content.marks.flagged.has(frame)) continue;
    const { middle } = spanOf(place, frame);
    context.beginPath();
    context.moveTo(middle - 4.5, 0);
    context.lineTo(middle + 4.5, 0);
    context.lineTo(middle, 8);
    context.closePath();
    context.fill();
  }

  context.fillStyle = colors.accent;
  runs(shown, content.marks.submitted).forEach(([from, to]) => {
    const start = spanOf(place, from).x;
    const end = spanOf(place, to).x + spanOf(place, to).w;
    context.fillRect(start, submitted + 1, Math.max(2, end - start), 2);
    // A tick at both ends makes a bracket of it.
    context.fillRect(start, submitted - 1, 2, 4);
    context.fillRect(Math.max(start, end - 2), submitted - 1, 2, 4);
  });

  if (content.asked) {
    const { asked } = content;
    const others = new Set(shown.filter((frame) => !asked.has(frame)));
    context.globalAlpha = 0.35;
    context.strokeStyle = colors.quiet;
    context.lineWidth = 1;
    for (const [from, to] of runs(shown, others)) {
      const [start, end] = [spanOf(place, from).x, spanOf(place, to).x + spanOf(place, to).w];
      for (const { top, height: tall } of lanes.slice(0, content.hands.length)) {
        context.beginPath();
        context.moveTo(start, top + tall / 2);
        context.lineTo(end, top + tall / 2);
        context.stroke();
      }
    }
    context.globalAlpha = 1;
  }

  context.fillStyle = colors.quiet;
  context.font = '11px "Inter Variable", system-ui, sans-serif';
  context.textBaseline = "top";
  const step = tickStep(window, width);
  for (let frame = Math.ceil(window.from / step) * step; frame < Math.min(content.frameCount, window.from + window.count); frame += step) {
    const { middle } = spanOf(place, frame);
    context.fillRect(Math.floor(middle), axis, 1, 3);
    const text = String(frame);
    const half = context.measureText(text).width / 2;
    context.fillText(text, Math.min(width - 2 * half, Math.max(0, middle - half)), axis + 4);
  }
}
