import { Table } from "@mantine/core";
import type { CSSProperties, ReactNode } from "react";
import classes from "./Evaluations.module.css";

interface BarCellProps {
  value: number | null;
  /** Where the bar is full. */
  full: number;
  /** What is written; the value with two digits when left out. */
  children?: ReactNode;
  /** The best of its column, marked by weight and a line under it. */
  isBest?: boolean;
  color?: string;
  title?: string;
}

/** A number with a small bar under it. */
export function BarCell({ value, full, children, isBest = false, color, title }: BarCellProps) {
  if (value === null) return <Table.Td ta="right">–</Table.Td>;
  const share = full > 0 ? Math.min(100, Math.max(0, (100 * value) / full)) : 0;
  const style = { "--share": `${share}%`, ...(color ? { "--bar-color": color } : {}) } as CSSProperties;
  return (
    <Table.Td className={classes.bar} style={style} title={title}>
      <span className={isBest ? classes.best : undefined}>{children ?? value.toFixed(2)}</span>
    </Table.Td>
  );
}
