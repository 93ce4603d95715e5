import { SimpleGrid, Table, Title } from "@mantine/core";
import type { ReactNode } from "react";
import type { CameraReport, ImportReport, ObjectReport } from "../../api/types";
import { formatCount, formatNumber } from "../../model/format";
import { formatSize } from "../../model/scanUnit";
import { Fact } from "./Fact";

/** "12 %", "0.4 %", and never "-0 %". */
const percent = (share: number): string => {
  const digits = share !== 0 && Math.abs(share) < 0.1 ? 1 : 0;
  return `${(Number((100 * share).toFixed(digits)) || 0).toFixed(digits)} %`;
};
const metres = (values: readonly number[], index: number): string => formatNumber(values[index], 3);

/** What is said of a camera, row by row; a row that says nothing of any camera is left out. */
const ROWS: readonly (readonly [string, (camera: CameraReport) => ReactNode])[] = [
  ["Size", (camera) => (camera.width > 0 ? `${camera.width} × ${camera.height} px` : null)],
  ["Colour images", (camera) => camera.color_frames || null],
  ["Depth images", (camera) => camera.depth_frames || null],
  [
    "Kinds of files",
    (camera) =>
      Object.entries(camera.image_types)
        .map(([kind, count]) => `${count} ${kind.replace(/^color:/, "colour:")}`)
        .join(", ") || null,
  ],
  ["Missing frames", (camera) => (camera.gaps.length > 0 ? camera.gaps.join("; ") : "none")],
  [
    "Timestamps",
    ({ timestamps }) =>
      timestamps &&
      `every ${formatNumber(1000 * timestamps.median_interval_s)} ms, jitter ${formatNumber(1000 * timestamps.jitter_s)} ms, ` +
        `${timestamps.dropped > 0 ? `${timestamps.dropped} seem dropped` : "none dropped"}${timestamps.monotonic ? "" : ", not in order"}`,
  ],
  ["Nearest thing", ({ depth }) => (depth && typeof depth.nearest_m === "number" ? `${formatNumber(depth.nearest_m, 2)} m away` : null)],
  [
    "Depth range",
    ({ depth }) =>
      depth && depth.percentiles_m.length >= 5
        ? `${metres(depth.percentiles_m, 0)} to ${metres(depth.percentiles_m, 4)} m, median ${metres(depth.percentiles_m, 2)} m`
        : depth
          ? "not known without the depth unit"
          : null,
  ],
  [
    "Without depth",
    ({ depth }) => depth && `${percent(depth.zero_share)} of the pixels${depth.empty_frames > 0 ? `, ${depth.empty_frames} of ${depth.sampled_frames} frames looked at` : ""}`,
  ],
  ["Field of view", ({ calibration }) => calibration && calibration.field_of_view_deg.map((angle) => `${formatNumber(angle)}°`).join(" × ")],
  ["Principal point off the centre", ({ calibration }) => calibration && calibration.principal_offset.map(percent).join(", ")],
  ["Distortion", ({ calibration }) => calibration && (calibration.distortion > 0 ? formatCount(calibration.distortion, "coefficient") : "none")],
  ["Position", ({ calibration }) => calibration && `${calibration.centre_m.map((value) => formatNumber(value, 3)).join(", ")} m`],
];

/** "ball, 5.2 × 5.2 × 5.2 cm (guessed)". */
function describeObject(name: string, sizes: readonly ObjectReport[]): string {
  const found = sizes.find((one) => one.name === name && one.size_m.length > 0);
  return found ? `${name}, ${formatSize(found.size_m)}${found.is_guessed ? " (guessed)" : ""}` : name;
}

/** The figures of an import report. */
export function ImportFacts({ report }: { report: ImportReport }) {
  const cameras = report.cameras ?? [];
  const rows = ROWS.map(([label, tell]) => [label, cameras.map(tell)] as const).filter(([, cells]) => cells.some((cell) => cell !== null && cell !== undefined));
  const baselines = Object.entries(report.baselines_m ?? {});
  return (
    <>
      <SimpleGrid cols={{ base: 2, sm: 5 }} spacing="md">
        <Fact label="Frames">{report.frame_count.toLocaleString("en")}</Fact>
        <Fact label="Frames per second">{formatNumber(report.fps, report.fps !== null && Number.isInteger(report.fps) ? 0 : 2)}</Fact>
        <Fact label="Hands">{report.hands.join(", ") || "–"}</Fact>
        <Fact label="Objects">{report.objects.map((name) => describeObject(name, report.object_sizes ?? [])).join("; ") || "none"}</Fact>
        <Fact label="Annotations">{report.annotations}</Fact>
      </SimpleGrid>
      {cameras.length > 0 && (
        <section className="card" style={{ padding: 16, overflowX: "auto" }} aria-label="Cameras in these files">
          <Title order={2} mb="sm">
            {formatCount(cameras.length, "camera")}
          </Title>
          <Table>
            {cameras.length > 1 && (
              <Table.Thead>
                <Table.Tr>
                  <Table.Th w={208} />
                  {cameras.map((camera) => (
                    <Table.Th key={camera.id}>{camera.id}</Table.Th>
                  ))}
                </Table.Tr>
              </Table.Thead>
            )}
            <Table.Tbody>
              {rows.map(([label, cells]) => (
                <Table.Tr key={label}>
                  <Table.Th w={208} fw={400} className="quiet">
                    {label}
                  </Table.Th>
                  {cells.map((cell, index) => (
                    <Table.Td key={cameras[index]?.id} style={{ overflowWrap: "anywhere" }}>
                      {cell ?? "–"}
                    </Table.Td>
                  ))}
                </Table.Tr>
              ))}
              {baselines.map(([pair, distance]) => (
                <Table.Tr key={pair}>
                  <Table.Th w={208} fw={400} className="quiet">
                    Distance {pair}
                  </Table.Th>
                  <Table.Td colSpan={cameras.length}>{formatNumber(distance, 3)} m</Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </section>
      )}
    </>
  );
}
