import { Skeleton } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useMemo } from "react";
import { useFrameEnergy } from "../../api/tracks";
import type { FrameEnergy, Track, TrackFrames } from "../../api/types";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { PlotLegend } from "../../canvas/PlotLegend";
import { formatName } from "../../model/format";
import { termStyle } from "../../model/terms";
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

const curvesOf = (costs: Record<string, (number | null)[]>): Curve[] =>
  Object.entries(costs).map(([term, values]) => ({
    label: formatName(term),
    unit: "",
    values,
    ...termStyle(term),
    axis: "Energy, mm²",
    digits: 0,
  }));

/** Energy of each term over the frames and, beside it, over the iterations of the frame one is at. */
export function EnergyPlots({ track, frames, lost, frame, isLog, onSeek }: EnergyPlotsProps) {
  const curves = useMemo(() => curvesOf(frames.costs), [frames]);
  return (
    <>
    <PlotLegend curves={curves} index={frames.frame.indexOf(frame)} />
    <div className={classes.pair}>
      <div className={classes.half} style={{ flex: "none", width: "50%" }}>
        <div className={classes.caption}>By frame, last iteration</div>
        <Plot label="Energy of each term by frame" frames={frames.frame} curves={curves} lost={lost} frame={frame} onSeek={onSeek} isLog={isLog} hasLegend={false} />
      </div>
      <Iterations track={track} frame={frame} isLog={isLog} />
    </div>
    </>
  );
}

function Iterations({ track, frame, isLog }: { track: Track; frame: number; isLog: boolean }) {
  const [settled] = useDebouncedValue(frame, 60);
  const { data, error } = useFrameEnergy(track.id, settled);
  const curves = useMemo(() => curvesOf(data?.costs ?? {}), [data]);
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
