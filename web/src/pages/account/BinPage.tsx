import { Button, Group, Select, Skeleton, Table, Text, Title } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconTrash } from "@tabler/icons-react";
import { useState } from "react";
import { useSearchParams } from "react-router";
import { useBin, useRestore, type BinItem } from "../../api/bin";
import { formatAgo, formatBytes } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { ShowMore } from "../parts/ShowMore";
import { useTitle } from "../parts/useTitle";
import { tellFailure } from "../parts/undo";
import classes from "./account.module.css";
import { EraseDialog } from "./EraseDialog";

const KINDS = [
  { value: "recording", label: "Recordings" },
  { value: "track", label: "Tracks" },
  { value: "scan", label: "Scans" },
  { value: "moving_scan", label: "Moving scans" },
  { value: "hand_model", label: "Hand models" },
  { value: "detector", label: "Fingertip detectors" },
  { value: "calibration", label: "Camera calibrations" },
  { value: "project", label: "Projects" },
  { value: "replica_set", label: "Blind replicas" },
];

/** What was deleted, of every kind, and the way back. */
export default function BinPage() {
  useTitle("Bin");
  const [address, setAddress] = useSearchParams();
  const kind = address.get("kind");
  const list = useBin(kind);
  const restore = useRestore();
  const [erased, setErased] = useState<BinItem | null>(null);
  const items = list.data?.pages.flatMap((page) => page.items);
  if (list.error && !items) return <Failure what="The bin could not be loaded" error={list.error} safe="Nothing in it is lost." onRetry={() => void list.refetch()} />;
  return (
    <div className="page">
      <Title order={1} mb="lg">
        Bin
      </Title>
      <section className={classes.card}>
        <Group gap="md" mb="md" align="end" justify="space-between">
          <Select w={208} label="What" placeholder="everything" clearable data={KINDS} value={kind} onChange={(value) => setAddress(value ? { kind: value } : {}, { replace: true })} />
          <Text size="sm" className="quiet">
            Nothing leaves the bin by itself. What is restored is as it was; what is deleted here cannot be restored.
          </Text>
        </Group>
        {items?.length === 0 && (
          <EmptyState icon={<IconTrash size={48} stroke={1.25} />} title="The bin is empty">
            Recordings, tracks, scans, models and projects that somebody deletes are kept here, and can be restored.
          </EmptyState>
        )}
        {!items && <Skeleton height={240} />}
        {items && items.length > 0 && (
          <div className="table-scroll">
            <Table verticalSpacing="xs" highlightOnHover miw={760}>
              <Table.Thead>
                <Table.Tr>
                  <Table.Th w={144}>What</Table.Th>
                  <Table.Th>Name</Table.Th>
                  <Table.Th w={160}>Deleted</Table.Th>
                  <Table.Th w={160}>By</Table.Th>
                  <Table.Th w={104} ta="right">
                    Size
                  </Table.Th>
                  <Table.Th w={192} />
                </Table.Tr>
              </Table.Thead>
              <Table.Tbody>
                {items.map((item) => (
                  <Table.Tr key={item.id}>
                    <Table.Td>{item.word.replace(/^./, (letter) => letter.toUpperCase())}</Table.Td>
                    <Table.Td style={{ overflowWrap: "anywhere" }}>{item.name}</Table.Td>
                    <Table.Td title={item.deleted_at}>{formatAgo(item.deleted_at)}</Table.Td>
                    <Table.Td>{item.deleted_by_name ?? <span className="quiet">–</span>}</Table.Td>
                    <Table.Td ta="right">{item.byte_count === null ? <span className="quiet">–</span> : formatBytes(item.byte_count)}</Table.Td>
                    <Table.Td ta="right">
                    <Group gap="xs" justify="flex-end" wrap="nowrap" className="keep-line">
                        <Button
                          size="compact-xs"
                          variant="default"
                          aria-label={`Restore ${item.name}`}
                          loading={restore.isPending && restore.variables?.ids[0] === item.id}
                          onClick={() => restore.mutate({ kind: item.kind, ids: [item.id] }, { onSuccess: () => notifications.show({ message: `${item.name} is back.` }), onError: tellFailure })}
                        >
                          Restore
                        </Button>
                      <Button size="compact-xs" variant="subtle" color="red" c="var(--bad-text)" aria-label={`Delete ${item.name} for good`} onClick={() => setErased(item)}>
                        Delete ...
                      </Button>
                    </Group>
                    </Table.Td>
                  </Table.Tr>
                ))}
              </Table.Tbody>
            </Table>
          </div>
        )}
        <ShowMore list={list} />
      </section>
      <EraseDialog item={erased} onClose={() => setErased(null)} />
    </div>
  );
}
