import { Switch, Tabs, Text } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import { useMemo } from "react";
import { useEvaluation } from "../../api/tracks";
import type { Track, TrackFrames } from "../../api/types";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { formatMeasure } from "../../model/format";
import { CameraPlots } from "./CameraPlots";
import { EnergyPlots } from "./EnergyPlots";
import classes from "./TrackReview.module.css";

interface TrackPlotsProps {
  track: Track;
  frames: TrackFrames;
  lost: readonly number[];
  frame: number;
  camera: string;
  tab: string;
  onTab: (tab: string) => void;
  onCamera: (camera: string) => void;
  onSeek: (frame: number) => void;
}

/** Error and timing by frame; a click goes there. */
export function TrackPlots({ track, frames, lost, frame, camera, tab, onTab, onCamera, onSeek }: TrackPlotsProps) {
  const evaluation = useEvaluation(track.id).data;
  const [isLog, setLog] = useLocalStorage({ key: "handloom/energy-log", defaultValue: true, getInitialValueInEffect: false });

  const fitCurves = useMemo<Curve[]>(
    () => [
      { label: "Depth residual", unit: "mm", values: frames.depth_residual_mm, color: "#e8795a", axis: "Residual, mm" },
      { label: "Silhouette IoU", unit: "", values: frames.silhouette_iou, color: "#5f9bd6", dash: [5, 3], axis: "IoU, 0 to 1", digits: 2 },
    ],
    [frames],
  );

  /** Of the frames that somebody annotated; empty without any. */
  const annotatedCurves = useMemo<Curve[]>(() => {
    const errors = new Map<number, number>();
    for (const item of evaluation?.items ?? []) {
      if (item.camera === camera && item.mean_px !== null) errors.set(item.frame, Math.max(item.mean_px, errors.get(item.frame) ?? 0));
    }
    if (errors.size === 0) return [];
    return [{ label: "Annotated error", unit: "px", values: frames.frame.map((at) => errors.get(at) ?? null), color: "#b08cff", axis: "Error, px", isSparse: true }];
  }, [frames, evaluation, camera]);

  const timingCurves = useMemo<Curve[]>(
    () => [
      { label: "Time", unit: "ms", values: frames.seconds.map((value) => (value === null ? null : 1000 * value)), color: "#36b8a8", axis: "Time, ms" },
      { label: "Iterations", unit: "", values: frames.iterations, color: "#9aa7b5", dash: [5, 3], axis: "Iterations", digits: 0 },
    ],
    [frames],
  );

  const leftOut = evaluation && evaluation.left_out_joints > 0 ? `, ${evaluation.left_out_joints} suggested joints left out` : "";
  const hasDepth = frames.depth_residual_mm.some((value) => value !== null);
  const hasEnergy = Object.keys(frames.costs).length > 0;
  const stages = Object.entries(track.summary.stages_ms ?? {});
  return (
    <Tabs value={tab} onChange={(next) => next && onTab(next)} className={classes.plots} data-tall={tab === "energy" || tab === "cameras" || (tab === "error" && annotatedCurves.length > 0) || undefined} keepMounted={false}>
      <Tabs.List style={{ flexWrap: "nowrap" }}>
        <Tabs.Tab value="error">Error</Tabs.Tab>
        {frames.views.length > 0 && <Tabs.Tab value="cameras">Cameras</Tabs.Tab>}
        {hasEnergy && <Tabs.Tab value="energy">Energy</Tabs.Tab>}
        <Tabs.Tab value="timing">Timing</Tabs.Tab>
        {tab === "energy" && (
          <Switch size="xs" ml="auto" my="auto" px={12} label="Logarithmic" checked={isLog} onChange={(event) => setLog(event.currentTarget.checked)} />
        )}
        <Text size="xs" className="quiet one-line" ml="auto" my="auto" px={12} hidden={tab === "energy"}>
          {tab === "cameras"
            ? "medians over all frames"
            : tab === "timing"
            ? `median ${formatMeasure(track.summary.median_ms, "ms")}, 95 % below ${formatMeasure(track.summary.p95_ms, "ms")}`
            : evaluation && evaluation.evaluated > 0
              ? `${formatMeasure(evaluation.joint_error_px.mean, "px")} mean error in ${evaluation.evaluated} annotated${leftOut}`
              : leftOut
                ? `no joint counts${leftOut}`
                : "annotate frames for an error in px"}
        </Text>
      </Tabs.List>
      <Tabs.Panel value="error" className={classes.plot}>
        {(hasDepth || annotatedCurves.length === 0) && <Plot label="Error by frame" frames={frames.frame} curves={fitCurves} lost={lost} frame={frame} onSeek={onSeek} />}
        {annotatedCurves.length > 0 && (
          <Plot label="Error against the annotations by frame" frames={frames.frame} curves={annotatedCurves} lost={lost} frame={frame} onSeek={onSeek} isBelowTwoAxes={hasDepth} />
        )}
      </Tabs.Panel>
      <Tabs.Panel value="cameras" className={classes.plot}>
        <CameraPlots track={track} frames={frames} lost={lost} frame={frame} camera={camera} onCamera={onCamera} onSeek={onSeek} />
      </Tabs.Panel>
      <Tabs.Panel value="energy" className={classes.plot}>
        <EnergyPlots track={track} frames={frames} lost={lost} frame={frame} isLog={isLog} onSeek={onSeek} />
      </Tabs.Panel>
      <Tabs.Panel value="timing" className={classes.plot}>
        <Plot label="Time by frame" frames={frames.frame} curves={timingCurves} lost={lost} frame={frame} onSeek={onSeek} />
        {stages.length > 0 && (
          <Text size="xs" className="quiet one-line" px={12} h={20}>
            {stages.map(([stage, ms]) => `${stage.replaceAll("_", " ")} ${formatMeasure(ms, "ms")}`).join(" · ")}
          </Text>
        )}
      </Tabs.Panel>
    </Tabs>
  );
}
