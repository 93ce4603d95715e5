import { Table } from "@mantine/core";
import type { HandChange } from "../../api/labels";
import { formatCount, formatNumber } from "../../model/format";
import { HandBadge } from "../parts/HandBadge";

export const CHANGE_HEADS = (
  <>
    <Table.Th ta="right">Frame</Table.Th>
    <Table.Th>Camera</Table.Th>
    <Table.Th>Hand</Table.Th>
    <Table.Th>What</Table.Th>
    <Table.Th ta="right">Shift, px</Table.Th>
  </>
);

export function describeChange(change: HandChange): string {
  if (change.kind === "added") return `${formatCount(change.joints_added.length, "joint")} added`;
  if (change.kind === "removed") return `${formatCount(change.joints_removed.length, "joint")} removed`;
  const parts = [
    [Object.keys(change.joints_moved).length, "moved"],
    [change.joints_added.length, "added"],
    [change.joints_removed.length, "removed"],
    [change.joints_restated.length, "of another state"],
  ] as const;
  return parts.flatMap(([count, what]) => (count > 0 ? [`${count} ${what}`] : [])).join(", ");
}

/** One hand that is different. */
export function ChangeCells({ change }: { change: HandChange }) {
  return (
    <>
      <Table.Td ta="right">{change.frame}</Table.Td>
      <Table.Td>{change.camera}</Table.Td>
      <Table.Td>
        <HandBadge hand={change.hand} />
      </Table.Td>
      <Table.Td>{describeChange(change)}</Table.Td>
      <Table.Td ta="right">{change.max_shift_px > 0 ? formatNumber(change.max_shift_px, 2) : "–"}</Table.Td>
    </>
  );
}
