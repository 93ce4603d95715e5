import { ActionIcon, Group, Select, Skeleton, Table, Text, Title, Tooltip } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import { Link } from "react-router";
import { useComparison, type Snapshot } from "../../api/labels";
import type { Recording } from "../../api/types";
import { formatCount, formatNumber } from "../../model/format";
import { Fact } from "../parts/Fact";
import { Failure } from "../parts/Failure";
import { ChangeCells, CHANGE_HEADS } from "./ChangeCells";
import classes from "./LabelsPage.module.css";

interface ComparisonProps {
  recording: Recording;
  snapshots: readonly Snapshot[];
  snapshot: string;
  other: string;
  onChoose: (snapshot: string | null, other?: string) => void;
}

/** What changed between two states of the labels; each line leads to its frame. */
export function Comparison({ recording, snapshots, snapshot, other, onChoose }: ComparisonProps) {
  const { data, error, refetch, isPending } = useComparison(recording.id, snapshot, other);
  const versions = snapshots.map(({ id, version, name }) => ({ value: id, label: `${version} · ${name}` }));
  return (
    <section aria-label="Comparison">
      <Group justify="space-between" mb="sm" wrap="nowrap">
        <Title order={2}>What changed</Title>
        <Group gap="sm" wrap="nowrap">
          <Select aria-label="From" data={versions} value={snapshot} onChange={(value) => value && onChoose(value, other)} allowDeselect={false} w={200} />
          <Text size="sm" className="quiet">
            to
          </Text>
          <Select aria-label="To" data={[{ value: "now", label: "Now" }, ...versions]} value={other} onChange={(value) => value && onChoose(snapshot, value)} allowDeselect={false} w={200} />
          <Tooltip label="Close the comparison">
            <ActionIcon aria-label="Close the comparison" onClick={() => onChoose(null)}>
              <IconX size={16} />
            </ActionIcon>
          </Tooltip>
        </Group>
      </Group>
      {error && <Failure what="These labels could not be compared" error={error} safe="The current labels are unchanged." onRetry={() => void refetch()} />}
      {isPending && !error && <Skeleton h={160} />}
      {data && (
        <div className="card" style={{ padding: 16 }}>
          <div className={classes.numbers} data-testid="comparison">
            <Fact label="Hands added">{data.hands_added}</Fact>
            <Fact label="Hands removed">{data.hands_removed}</Fact>
            <Fact label="Hands changed">{data.hands_changed}</Fact>
            <Fact label="Joints added">{data.joints_added}</Fact>
            <Fact label="Joints removed">{data.joints_removed}</Fact>
            <Fact label="Joints moved">{data.joints_moved}</Fact>
            <Fact label="Mean shift, px">{formatNumber(data.mean_shift_px, 2)}</Fact>
            <Fact label="Largest shift, px">{formatNumber(data.max_shift_px, 2)}</Fact>
          </div>
          {data.items.length === 0 ? (
            <Text size="sm" className="quiet" mt="md">
              Nothing: the two hold the same labels.
            </Text>
          ) : (
            <div className={classes.frame}>
              <Table verticalSpacing="xs" horizontalSpacing="sm" mt="md">
                <Table.Thead>
                  <Table.Tr>
                    {CHANGE_HEADS}
                    <Table.Th aria-label="Open" />
                  </Table.Tr>
                </Table.Thead>
                <Table.Tbody>
                  {data.items.map((change) => (
                    <Table.Tr key={`${change.frame} ${change.camera} ${change.hand}`}>
                      <ChangeCells change={change} />
                      <Table.Td ta="right">
                        <Link to={`/recordings/${recording.id}/annotate?frame=${change.frame}&camera=${encodeURIComponent(change.camera)}`} style={{ color: "var(--accent-text)", fontSize: 13 }}>
                          Open
                        </Link>
                      </Table.Td>
                    </Table.Tr>
                  ))}
                </Table.Tbody>
              </Table>
            </div>
          )}
          {data.is_cut && (
            <Text size="sm" className="quiet" mt="sm">
              The first {formatCount(data.items.length, "hand is", "hands are")} listed; the numbers above count all.
            </Text>
          )}
        </div>
      )}
    </section>
  );
}
