import { Group } from "@mantine/core";
import type { ReactNode } from "react";
import { formatAgo } from "../../model/format";
import { CardTable, type Column } from "../parts/CardTable";
import classes from "./Models.module.css";

interface Kept {
  id: string;
  name: string;
  digest: string;
  created_at: string;
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
  const all: readonly Column<Item>[] = [
    { head: "Name", full: ({ name }) => name, show: ({ name }) => name },
    ...columns,
    { head: "SHA-256", width: 128, full: ({ digest }) => digest, show: ({ digest }) => <span className={classes.digest}>{digest.slice(0, 12)}</span> },
    { head: when, width: 128, isNumber: true, isQuiet: true, show: ({ created_at: at }) => formatAgo(at) },
    {
      head: "",
      label: "Acts",
      width: actsWidth,
      show: (item) => (
        <Group gap={4} justify="flex-end" wrap="nowrap" className="keep-line">
          {acts(item)}
        </Group>
      ),
    },
  ];
  return <CardTable items={items} columns={all} />;
}
