import { Table, Text, UnstyledButton } from "@mantine/core";
import { useMemo } from "react";
import type { Track, TrackFrames } from "../../api/types";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { formatNumber } from "../../model/format";
import classes from "./TrackReview.module.css";

interface CameraPlotsProps {
  track: Track;
  frames: TrackFrames;
  lost: readonly number[];
  frame: number;
  camera: string;
  onCamera: (camera: string) => void;
  onSeek: (frame: number) => void;
}

/** How well each camera agrees with the fit and with the others, and the shown one's curves. */
export function CameraPlots({ track, frames, lost, frame, camera, onCamera, onSeek }: CameraPlotsProps) {
  const { views } = frames;
  const shown = views.find((view) => view.camera === camera);
  const rows = Object.entries(track.summary.views ?? {});
  const curves = useMemo<Curve[]>(
    () =>
      shown
        ? [
            { label: "Fit", unit: "px", values: shown.fit_px, color: "#e8795a", axis: "From detector, px" },
            { label: "Other cameras", unit: "px", values: shown.left_out_px, color: "#5f9bd6", dash: [5, 3], axis: "From detector, px" },
            { label: "Weight", unit: "", values: shown.weight, color: "#9aa7b5", dash: [2, 3], axis: "Weight, 0 to 1", digits: 2 },
          ]
        : [],
    [shown],
  );
  return (
    <>
      <div className={classes.cameras}>
        {(track.summary.doubts ?? []).map((doubt) => (
          <Text key={doubt} size="xs" c="var(--warn-text)" role="note">
            {doubt}
          </Text>
        ))}
        <Table verticalSpacing={2} fz="xs" aria-label="Cameras">
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Camera</Table.Th>
              <Table.Th ta="right" title="From where the detector saw the joints to the fitted joints">
                Fit, px
              </Table.Th>
              <Table.Th ta="right" title="From the detected joints to the points that the other cameras’ detections give: large in a camera that moved, is out of step or detects wrongly">
                Others, px
              </Table.Th>
              <Table.Th ta="right" title="How much the camera’s joints count in the fit, 0 to 1">
                Weight
              </Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {rows.map(([name, { fit_px, left_out_px, weight }]) => (
              <Table.Tr key={name}>
                <Table.Td>
                  <UnstyledButton className={classes.cameraName} aria-pressed={name === camera} title={name} onClick={() => onCamera(name)}>
                    {name}
                  </UnstyledButton>
                </Table.Td>
                <Table.Td ta="right">{formatNumber(fit_px, 1)}</Table.Td>
                <Table.Td ta="right">{formatNumber(left_out_px, 1)}</Table.Td>
                <Table.Td ta="right">{formatNumber(weight, 2)}</Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </div>
      {shown ? (
        <Plot label={`How well ${camera} agrees, by frame`} frames={frames.frame} curves={curves} lost={lost} frame={frame} onSeek={onSeek} />
      ) : (
        <div className={classes.nothing}>Choose a camera that was tracked in.</div>
      )}
    </>
  );
}
