import { Table, Text } from "@mantine/core";
import type { RefinedCamera, Refinement } from "../../api/refinements";
import { formatMeasure, formatNumber } from "../../model/format";

/** One standard deviation beyond which labels do not tell where a camera stands; the tracker's `MAX_UNSURE_PX`. */
const MAX_UNSURE_PX = 5;

/** "5.06 → 1.51": rms before and after, px. */
function BeforeAfter({ px }: { px: RefinedCamera["fitted_px"] }) {
  return (
    <Table.Td ta="right" style={{ whiteSpace: "nowrap" }}>
      {formatNumber(px.before.rms, 2)} → {formatNumber(px.after.rms, 2)}
    </Table.Td>
  );
}

function Row({ camera }: { camera: RefinedCamera }) {
  if (camera.fitted_px.before.joints === 0)
    return (
      <Table.Tr>
        <Table.Td>{camera.id}</Table.Td>
        <Table.Td colSpan={5} className="quiet">
          stays as it is: too few of its labels are in another camera too
        </Table.Td>
      </Table.Tr>
    );
  const isUnsure = camera.unsure_px > MAX_UNSURE_PX;
  return (
    <Table.Tr>
      <Table.Td>{camera.id}</Table.Td>
      <BeforeAfter px={camera.fitted_px} />
      <BeforeAfter px={camera.left_out_px} />
      <Table.Td ta="right">{camera.is_moved ? formatMeasure(camera.moved_mm, "mm") : "stands still"}</Table.Td>
      <Table.Td ta="right">{camera.is_moved ? `${formatNumber(camera.turned_deg, 2)}°` : "–"}</Table.Td>
      <Table.Td ta="right" c={isUnsure ? "var(--bad-text)" : undefined} fw={isUnsure ? 600 : undefined}>
        ±{formatNumber(camera.unsure_px)}
        {isUnsure && " !"}
      </Table.Td>
    </Table.Tr>
  );
}

/** Each camera before and after: how far labels are off, and how far it moved. */
export function RefinementTable({ refinement: { report } }: { refinement: Refinement }) {
  return (
    <>
      <Table.ScrollContainer minWidth={560}>
        <Table verticalSpacing="xs" horizontalSpacing="md">
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Camera</Table.Th>
              <Table.Th ta="right">Fitted labels, rms px</Table.Th>
              <Table.Th ta="right">Left out, rms px</Table.Th>
              <Table.Th ta="right">Moved</Table.Th>
              <Table.Th ta="right">Turned</Table.Th>
              <Table.Th ta="right">Unsure, px</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {report.cameras.map((camera) => (
              <Row key={camera.id} camera={camera} />
            ))}
          </Table.Tbody>
        </Table>
      </Table.ScrollContainer>
      <Text size="sm" className="quiet">
        Fitted to {report.frames} labelled frames, judged by {report.frames_left_out} left out. {report.kept}
      </Text>
    </>
  );
}
