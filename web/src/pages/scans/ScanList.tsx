import { Button, Group, TextInput, Title } from "@mantine/core";
import { useDebouncedCallback } from "@mantine/hooks";
import { IconFilterOff, IconSearch } from "@tabler/icons-react";
import type { InfiniteData, UseInfiniteQueryResult } from "@tanstack/react-query";
import { useState, type ReactNode } from "react";
import { Link } from "react-router";
import type { Page } from "../../api/types";
import { formatAgo } from "../../model/format";
import { CardTable, type Column } from "../parts/CardTable";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { LoadingRows } from "../parts/LoadingRows";
import { ShowMore } from "../parts/ShowMore";
import { Thumbnail } from "../parts/Thumbnail";
import { ScanKinds } from "./ScanKinds";
import classes from "./ScanList.module.css";

interface Listed {
  id: string;
  name: string;
  subject: string;
  point_count: number;
  created_at: string;
}

export const nameColumn = <S extends Listed>(folder: string, thumbnailUrl: (scan: S) => string): Column<S> => ({
  head: "Name",
  full: ({ name }) => name,
  show: (scan) => (
    <Link to={`${folder}/${scan.id}`} className={classes.named}>
      <Thumbnail className={classes.picture} src={thumbnailUrl(scan)} alt="" width={32} height={32} />
      <span className="one-line">{scan.name}</span>
    </Link>
  ),
});

export const subjectColumn = (width: number): Column<Listed> => ({ head: "Subject", width, full: ({ subject }) => subject, show: ({ subject }) => subject });

export const pointsColumn = (head: string, width: number): Column<Listed> => ({ head, width, isNumber: true, show: ({ point_count: count }) => count.toLocaleString("en") });

export const ADDED: Column<Listed> = { head: "Added", width: 128, isNumber: true, isQuiet: true, show: ({ created_at: when }) => formatAgo(when) };

interface ScanListProps<S> {
  here: "/scans" | "/scans/moving";
  /** What one of them is called: "moving scan". */
  noun: string;
  list: UseInfiniteQueryResult<InfiniteData<Page<S>>>;
  columns: readonly Column<S>[];
  search: string | undefined;
  /** "name or subject" */
  searched: string;
  onSearch: (search: string | undefined) => void;
  isNarrowed: boolean;
  onShowAll: () => void;
  /** Before the first one is there. */
  firstUse: ReactNode;
  count?: ReactNode;
  /** Right of the heading. */
  acts: ReactNode;
  /** Beside the search. */
  filters?: ReactNode;
  /** Above the rows: what can be done with those that are chosen. */
  children?: ReactNode;
}

/** A page of scans of one kind: looked for, listed, and how to get the first one. */
export function ScanList<S extends Listed>({ here, noun, list, columns, search, searched, onSearch, isNarrowed, onShowAll, firstUse, count, acts, filters, children }: ScanListProps<S>) {
  const { data, error } = list;
  const [typed, setTyped] = useState(search ?? "");
  const seek = useDebouncedCallback((text: string) => onSearch(text.trim() || undefined), 250);
  if (error && !data) return <Failure what={`The ${noun}s could not be loaded`} error={error} safe="They are untouched on the server's disk." onRetry={() => void list.refetch()} />;
  const scans = data?.pages.flatMap((page) => page.items);
  const isEmpty = scans?.length === 0;
  /** Known to be more than the first-use state, so that nothing jumps. */
  const hasList = scans !== undefined && (!isEmpty || isNarrowed);
  return (
    <div className="page">
      <Group mb="md" justify="space-between" wrap="nowrap">
        <Group gap="md" wrap="nowrap">
          <Title order={1}>Scans</Title>
          <ScanKinds here={here} />
          {hasList && count}
        </Group>
        {hasList && (
          <Group gap="sm" wrap="nowrap">
            {acts}
          </Group>
        )}
      </Group>
      {hasList && (
        <div className={classes.filters}>
          <TextInput
            value={typed}
            onChange={(event) => {
              setTyped(event.currentTarget.value);
              seek(event.currentTarget.value);
            }}
            placeholder={`Filter by ${searched}`}
            aria-label={`Filter ${noun}s by ${searched}`}
            leftSection={<IconSearch size={16} aria-hidden />}
            w={240}
          />
          {filters}
        </div>
      )}
      {children}
      {!scans && <LoadingRows count={8} height={40} />}
      {isEmpty && !isNarrowed && firstUse}
      {isEmpty && isNarrowed && (
        <EmptyState
          icon={<IconFilterOff size={40} stroke={1.25} />}
          title={`No ${noun} matches`}
          action={
            <Button variant="default" onClick={() => (setTyped(""), onShowAll())}>
              Show all
            </Button>
          }
        >
          Change the filters above.
        </EmptyState>
      )}
      {scans && !isEmpty && <CardTable items={scans} columns={columns} />}
      <ShowMore list={list} />
    </div>
  );
}
