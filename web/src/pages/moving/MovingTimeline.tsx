import { useComputedColorScheme } from "@mantine/core";
import { useMemo } from "react";
import type { FrameRegistration, MovingScan } from "../../api/movingScans";
import { FrameStrip } from "../../canvas/FrameStrip";
import { formatMeasure } from "../../model/format";
import { movingRows, ROWS, type RowColors, type Stretch } from "../../model/stretch";
import classes from "./Moving.module.css";

interface MovingTimelineProps {
  scan: MovingScan;
  frames: readonly FrameRegistration[];
  frame: number;
  stretch: Stretch;
  onSeek: (frame: number) => void;
}

const COLORS: Record<"dark" | "light", RowColors> = {
  dark: { guessed: "#b08cff", accepted: "#36c3b4", rejected: "#ff5d52", chosen: "#98a0ab" },
  light: { guessed: "#7a4fe0", accepted: "#078577", rejected: "#c22a20", chosen: "#6d7580" },
};

/** All frames at once: distances, guessed hands, decisions, and the chosen stretch. Click or drag to go to a frame. */
export function MovingTimeline({ scan, frames, frame, stretch, onSeek }: MovingTimelineProps) {
  const scheme = useComputedColorScheme("dark");
  const rows = useMemo(() => movingRows(frames, scan.frame_count, stretch, COLORS[scheme]), [frames, scan.frame_count, stretch, scheme]);
  const found = useMemo(() => new Map(frames.map((one) => [one.frame, one])), [frames]);
  const describe = (at: number): string => {
    const one = found.get(at);
    if (scan.problems.some((problem) => problem.frame === at)) return `frame ${at}: cannot be used`;
    if (!one) return `frame ${at}`;
    const parts = [`frame ${at}: ${one.verdict}`, formatMeasure(one.mean_mm, "mm", 2), ...one.guessed.map((hand) => `${hand} hand guessed`)];
    if (one.decision) parts.push(one.decision === "accept" ? "accepted" : "rejected");
    return parts.join(", ");
  };
  return (
    <div className={classes.timeline}>
      <div className={classes.rows} aria-hidden>
        {ROWS.map((name) => (
          <span key={name}>{name}</span>
        ))}
      </div>
      <FrameStrip rows={rows} frameCount={scan.frame_count} frame={frame} height={78} label="Timeline" onSeek={onSeek} describe={describe} />
    </div>
  );
}
