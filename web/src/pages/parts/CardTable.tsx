import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import classes from "./CardTable.module.css";

export interface Column<Item> {
  head: ReactNode;
  /** Of a head without words. */
  label?: string;
  /** px; a column without one takes what is left. */
  width?: number;
  isNumber?: boolean;
  isQuiet?: boolean;
  /** In full, of a text that is cut off where it has no room. */
  full?: (item: Item) => string;
  /** A dash stands where there is nothing. */
  show: (item: Item) => ReactNode;
}

interface CardTableProps<Item> {
  items: readonly Item[];
  columns: readonly Column<Item>[];
}

/** A list with one thing a row, each column as wide as it says. */
export function CardTable<Item extends { id: string }>({ items, columns }: CardTableProps<Item>) {
  return (
    <div className={`card ${classes.frame}`}>
      <Table highlightOnHover verticalSpacing="xs" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            {columns.map(({ head, label, width, isNumber }, index) => (
              <Table.Th key={index} w={width} ta={isNumber ? "right" : undefined} aria-label={label}>
                {head}
              </Table.Th>
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {items.map((item) => (
            <Table.Tr key={item.id}>
              {columns.map(({ isNumber, isQuiet, full, show }, index) => (
                <Table.Td key={index} ta={isNumber ? "right" : undefined} className={[isQuiet ? "quiet" : "", full ? classes.cell : ""].join(" ")} title={full?.(item)}>
                  {show(item) || <span className="quiet">–</span>}
                </Table.Td>
              ))}
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}
