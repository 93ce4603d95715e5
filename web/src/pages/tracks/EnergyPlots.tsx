import { Skeleton, useComputedColorScheme } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useMemo } from "react";
import { useFrameEnergy } from "../../api/tracks";
import type { FrameEnergy, TermLook, Track, TrackFrames } from "../../api/types";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { PlotLegend } from "../../canvas/PlotLegend";
import classes from "./TrackReview.module.css";

interface EnergyPlotsProps {
  track: Track;
  frames: TrackFrames;
  lost: readonly number[];
  frame: number;
  isLog: boolean;
  onSeek: (frame: number) => void;
}

const NONE: readonly number[] = [];

/** A curve for each term that has costs, as the studio says that it looks. */
const curvesOf = (terms: readonly TermLook[], costs: Record<string, (number | null)[]>, isDark: boolean): Curve[] =>
  terms.flatMap(({ name, label, color, color_on_white: onWhite, dash }) => {
    const values = costs[name];
    return values ? { label, unit: "", values, color: isDark ? color : onWhite, ...(dash.length > 0 ? { dash } : {}), axis: "Energy, mm²", digits: 0 } : [];
  });

const useIsDark = (): boolean => useComputedColorScheme("dark") === "dark";

/** Energy of each term over the frames and, beside it, over the iterations of the frame one is at. */
export function EnergyPlots({ track, frames, lost, frame, isLog, onSeek }: EnergyPlotsProps) {
  const isDark = useIsDark();
  const curves = useMemo(() => curvesOf(frames.terms, frames.costs, isDark), [frames, isDark]);
  return (
    <>
    <PlotLegend curves={curves} index={frames.frame.indexOf(frame)} />
    <div className={classes.pair}>
      <div className={classes.half} style={{ flex: "none", width: "50%" }}>
        <div className={classes.caption}>By frame, last iteration</div>
        <Plot label="Energy of each term by frame" frames={frames.frame} curves={curves} lost={lost} frame={frame} onSeek={onSeek} isLog={isLog} hasLegend={false} />
      </div>
      <Iterations track={track} terms={frames.terms} frame={frame} isLog={isLog} />
    </div>
    </>
  );
}

function Iterations({ track, terms, frame, isLog }: { track: Track; terms: readonly TermLook[]; frame: number; isLog: boolean }) {
  const isDark = useIsDark();
  const [settled] = useDebouncedValue(frame, 60);
  const { data, error } = useFrameEnergy(track.id, settled);
  const curves = useMemo(() => curvesOf(terms, data?.costs ?? {}, isDark), [terms, data, isDark]);
  const iterations = useMemo(() => Array.from({ length: data?.iterations ?? 0 }, (_, place) => place + 1), [data]);
  const why = error ? `The iterations could not be loaded: ${error.message}` : data && explain(data);

  return (
    <div className={classes.half}>
      <div className={classes.caption}>By iteration, frame {data?.frame ?? settled}</div>
      {why ? (
        <p className={classes.nothing}>{why}</p>
      ) : data ? (
        <Plot label={`Energy of each term by iteration of frame ${data.frame}`} frames={iterations} curves={curves} lost={NONE} frame={null} isLog={isLog} hasLegend={false} />
      ) : (
        <Skeleton m={12} flex={1} />
      )}
    </div>
  );
}

/** Why there is nothing to draw, or null. */
function explain(energy: FrameEnergy): string | null {
  if (!energy.is_recorded) return "This track was made before the energy of every iteration was kept. Track the recording again to see it.";
  return energy.iterations === 0 ? "Nothing was fitted to this frame: no hand was found in it." : null;
}
