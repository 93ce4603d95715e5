import { Group, Table } from "@mantine/core";
import type { ReactNode } from "react";
import { formatAgo } from "../../model/format";
import classes from "./Models.module.css";

interface Kept {
  id: string;
  name: string;
  digest: string;
  created_at: string;
}

export interface Column<Item> {
  head: string;
  width: number;
  isNumber?: boolean;
  show: (item: Item) => ReactNode;
}

interface KeptTableProps<Item extends Kept> {
  items: readonly Item[];
  /** What stands between the name and the hash. */
  columns: readonly Column<Item>[];
  /** What happened at `created_at`: "Added". */
  when: string;
  actsWidth: number;
  acts: (item: Item) => ReactNode;
}

/** Files that the studio keeps under a hash, one a row. */
export function KeptTable<Item extends Kept>({ items, columns, when, actsWidth, acts }: KeptTableProps<Item>) {
  return (
    <div className={`card ${classes.frame}`}>
      <Table verticalSpacing="xs" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Name</Table.Th>
            {columns.map(({ head, width, isNumber }) => (
              <Table.Th key={head} w={width} ta={isNumber ? "right" : undefined}>
                {head}
              </Table.Th>
            ))}
            <Table.Th w={128}>SHA-256</Table.Th>
            <Table.Th w={128} ta="right">
              {when}
            </Table.Th>
            <Table.Th w={actsWidth} aria-label="Acts" />
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {items.map((item) => (
            <Table.Tr key={item.id}>
              <Table.Td className={classes.cell} title={item.name}>
                {item.name}
              </Table.Td>
              {columns.map(({ head, isNumber, show }) => (
                <Table.Td key={head} ta={isNumber ? "right" : undefined}>
                  {show(item)}
                </Table.Td>
              ))}
              <Table.Td className={classes.cell} title={item.digest} style={{ fontFamily: "var(--mantine-font-family-monospace)", fontSize: 12 }}>
                {item.digest.slice(0, 12)}
              </Table.Td>
              <Table.Td ta="right" className="quiet">
                {formatAgo(item.created_at)}
              </Table.Td>
              <Table.Td>
                <Group gap={4} justify="flex-end" wrap="nowrap" className="keep-line">
                  {acts(item)}
                </Group>
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}
