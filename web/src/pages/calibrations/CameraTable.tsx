import { Table } from "@mantine/core";
import type { CalibratedCamera, CalibrationResult, Residual } from "../../api/calibrations";
import { trackStyle } from "../../model/trackStyle";
import { formatNumber } from "../../model/format";
import classes from "./calibrations.module.css";

/** Above this at the median a camera is named among what to look at. */
const BAD_PX = 1;

/** "0.31 / 0.22": rms and median. */
export const sayResidual = ({ rms, median }: Residual): string => (rms === null ? "–" : `${formatNumber(rms, 2)} / ${formatNumber(median, 2)}`);

/** Marked where the tracker names a camera: moments left out are what it is judged by. */
function Cell({ residual, isJudged = false }: { residual: Residual; isJudged?: boolean }) {
  const isBad = isJudged && residual.median !== null && residual.median > BAD_PX;
  return (
    <Table.Td ta="right" c={isBad ? "var(--bad-text)" : undefined} fw={isBad ? 600 : undefined}>
      {sayResidual(residual)}
      {isBad && " !"}
    </Table.Td>
  );
}

/** m from the first camera. */
const distanceOf = ({ T_world_camera: T }: CalibratedCamera): number => Math.hypot(...[0, 1, 2].map((row) => T[row]?.[3] ?? 0));

/** Each camera: how well it fits what it was fitted to, and what it was not; when and where it stands. */
export function CameraTable({ result }: { result: CalibrationResult }) {
  return (
    <div className={`card ${classes.table}`}>
      <Table verticalSpacing="xs" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Camera</Table.Th>
            <Table.Th ta="right">With the board</Table.Th>
            <Table.Th ta="right">Fitted, px</Table.Th>
            <Table.Th ta="right">Left out, px</Table.Th>
            <Table.Th ta="right">By the others, px</Table.Th>
            <Table.Th ta="right">Later by, frames</Table.Th>
            <Table.Th ta="right">ms</Table.Th>
            <Table.Th ta="right">From the first, m</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {result.cameras.map((camera, place) => (
            <Table.Tr key={camera.id}>
              <Table.Td className={classes.name} title={camera.id}>
                <span aria-hidden style={{ color: trackStyle(place).color }}>
                  ■{" "}
                </span>
                {camera.id}
              </Table.Td>
              <Table.Td ta="right">
                {camera.frames_with_board} of {camera.frames}
              </Table.Td>
              <Cell residual={camera.residual_px.fitted} />
              <Cell residual={camera.residual_px.left_out} isJudged />
              <Cell residual={camera.residual_px.by_other_cameras} />
              <Table.Td ta="right">{camera.time_offset.known ? formatNumber(camera.time_offset.frames, 2) : "not told"}</Table.Td>
              <Table.Td ta="right">{camera.time_offset.known ? formatNumber(1000 * camera.time_offset.seconds) : "–"}</Table.Td>
              <Table.Td ta="right">{formatNumber(distanceOf(camera), 3)}</Table.Td>
            </Table.Tr>
          ))}
          <Table.Tr fw={600}>
            <Table.Td>All</Table.Td>
            <Table.Td />
            <Table.Td ta="right">{sayResidual(result.residual_px.fitted)}</Table.Td>
            <Table.Td ta="right">{sayResidual(result.residual_px.left_out)}</Table.Td>
            <Table.Td ta="right">{sayResidual(result.residual_px.by_other_cameras)}</Table.Td>
            <Table.Td colSpan={3} />
          </Table.Tr>
        </Table.Tbody>
      </Table>
    </div>
  );
}
