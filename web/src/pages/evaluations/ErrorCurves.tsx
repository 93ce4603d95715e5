import { Button, Group, Select, Text } from "@mantine/core";
import { IconCube, IconPencil } from "@tabler/icons-react";
import { useMemo, useState } from "react";
import { Link } from "react-router";
import type { Comparison } from "../../api/evaluations";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { trackStyle } from "../../model/trackStyle";
import { formatMeasure } from "../../model/format";
import classes from "./Evaluations.module.css";

/** More of them would only thicken the line. */
const MOST_DOTS = 60;

interface ErrorCurvesProps {
  comparison: Comparison;
  camera: string;
  onWithin: (px: number) => void;
}

/** Error over the annotated frames of one recording, and the share of joints below each error. */
export function ErrorCurves({ comparison, camera, onWithin }: ErrorCurvesProps) {
  const { tracks, thresholds_px: thresholds, within_px: within } = comparison;
  const recordings = [...new Map(tracks.map((track) => [track.recording_key, track.recording])).entries()];
  const [chosen, setChosen] = useState<string | null>(null);
  const recording = recordings.find(([key]) => key === chosen)?.[0] ?? recordings[0]?.[0];
  const [frame, setFrame] = useState<number | null>(null);

  const { frames, curves, lost } = useMemo(() => {
    const own = tracks.map((track, place) => ({ track, place })).filter(({ track }) => track.recording_key === recording);
    const all = [...new Set(own.flatMap(({ track }) => track.curve.frame))].sort((a, b) => a - b);
    const isOne = own.length === 1;
    const made = own.map(({ track, place }): Curve => {
      const values = new Map(track.curve.frame.map((at, index) => [at, track.curve.mean[index] ?? null]));
      return { label: track.name, unit: "px", values: all.map((at) => values.get(at) ?? null), axis: "Mean error, px", digits: 2, hasDots: all.length <= MOST_DOTS, ...trackStyle(place) };
    });
    return { frames: all, curves: made, lost: isOne ? (own[0]?.track.lost_frames ?? []) : [] };
  }, [tracks, recording]);

  const isOfSeveral = recordings.length > 1;
  const shares = useMemo(
    () =>
      tracks.map((track, place): Curve => ({
        label: isOfSeveral ? `${track.name}, ${track.recording}` : track.name,
        unit: "%",
        values: track.shares.map((share) => (share === null ? null : 100 * share)),
        axis: "Joints below, %",
        ...trackStyle(place),
      })),
    [tracks, isOfSeveral],
  );
  const nearest = thresholds.reduce((best, at) => (Math.abs(at - within) < Math.abs(best - within) ? at : best), thresholds[0] ?? 0);
  const place = frame === null ? "" : `frame=${frame}${camera ? `&camera=${encodeURIComponent(camera)}` : ""}`;
  const ofRecording = tracks.filter((track) => track.recording_key === recording);

  return (
    <div className={classes.plots}>
      <div>
        <Group justify="space-between" mb="xs" h={32}>
          <Text size="sm" fw={600}>
            Mean error by annotated frame
          </Text>
          {recordings.length > 1 && (
            <Select
              size="xs"
              aria-label="Recording of the curves"
              allowDeselect={false}
              data={recordings.map(([value, label]) => ({ value, label }))}
              value={recording ?? null}
              onChange={(key) => {
                setChosen(key);
                setFrame(null);
              }}
            />
          )}
        </Group>
        <div className={`card ${classes.plot}`}>
          <Plot label="Mean error by annotated frame" frames={frames} curves={curves} lost={lost} frame={frame} onSeek={setFrame} />
        </div>
        <Group gap="xs" mt="xs" mih={32}>
          {frame === null ? (
            <Text size="sm" className="quiet">
              Click a frame to open it in the annotator or in 3D.
            </Text>
          ) : (
            <>
              <Text size="sm">Frame {frame}:</Text>
              <Button size="compact-sm" variant="default" component={Link} to={`/recordings/${recording}/annotate?${place}`} leftSection={<IconPencil size={14} aria-hidden />}>
                Annotate
              </Button>
              {ofRecording.map((track) => (
                <Button key={track.key} size="compact-sm" variant="default" component={Link} to={`/tracks/${track.key}?${place}`} leftSection={<IconCube size={14} aria-hidden />}>
                  {track.name}, {formatMeasure(track.curve.mean[track.curve.frame.indexOf(frame)], "px", 2)}
                </Button>
              ))}
            </>
          )}
        </Group>
      </div>
      <div>
        <Group mb="xs" h={32}>
          <Text size="sm" fw={600}>
            Joints below an error, %
          </Text>
        </Group>
        <div className={`card ${classes.plot}`}>
          <Plot label="Share of joints below an error" frames={thresholds} curves={shares} lost={[]} frame={nearest} joinsAll onSeek={(px) => onWithin(Math.max(0.1, Number(px.toFixed(1))))} />
        </div>
        <Text size="sm" className="quiet" mt="xs">
          The line stands at {within} px; click to move it.
        </Text>
      </div>
    </div>
  );
}
