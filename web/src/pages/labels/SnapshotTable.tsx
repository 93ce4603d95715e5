import { ActionIcon, Button, CopyButton, Group, Menu, Skeleton, Stack, Table, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconArrowBackUp, IconCamera, IconCheck, IconCopy, IconDots, IconDownload, IconGitCompare, IconShieldCheck } from "@tabler/icons-react";
import type { UseQueryResult } from "@tanstack/react-query";
import { useState } from "react";
import { snapshotFileUrl, useCreateSnapshot, useRestoreSnapshot, verifySnapshot, type Snapshot } from "../../api/labels";
import type { Recording } from "../../api/types";
import { formatAgo, formatCount } from "../../model/format";
import { Failure } from "../parts/Failure";
import classes from "./LabelsPage.module.css";
import { useUndoable } from "./useUndoable";
import { For } from "../parts/For";

interface SnapshotTableProps {
  recording: Recording;
  snapshots: UseQueryResult<Snapshot[]>;
  compared: string | null;
  onCompare: (snapshot: string, other?: string) => void;
}

function KeepForm({ recording, next }: { recording: Recording; next: number }) {
  const [name, setName] = useState("");
  const create = useCreateSnapshot(recording.id);
  const keep = (): void =>
    create.mutate(name.trim() || `Labels ${next}`, {
      onSuccess: (made) => {
        setName("");
        notifications.show(
          made.version < next
            ? { message: `Nothing has changed: version ${made.version}, “${made.name}”, holds the same labels.` }
            : { message: `Kept as version ${made.version}.`, color: "teal" },
        );
      },
      onError: (failure) => notifications.show({ color: "red", title: "Not kept", message: failure.message }),
    });
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        keep();
      }}
    >
      <Group gap="sm" wrap="nowrap">
        <TextInput aria-label="Name of the snapshot" placeholder="Before the review" value={name} onChange={(event) => setName(event.currentTarget.value)} maxLength={200} w={220} />
        <Button type="submit" loading={create.isPending} leftSection={<IconCamera size={16} aria-hidden />}>
          Keep a snapshot
        </Button>
      </Group>
    </form>
  );
}

function Hash({ value }: { value: string }) {
  return (
    <CopyButton value={value} timeout={1500}>
      {({ copied, copy }) => (
        <Tooltip label={copied ? "Copied" : `Copy SHA-256 ${value}`}>
          <Button size="compact-xs" variant="subtle" color="gray" onClick={copy} className={classes.hash} aria-label={`Copy the hash ${value.slice(0, 12)}`} rightSection={copied ? <IconCheck size={12} aria-hidden /> : <IconCopy size={12} aria-hidden />}>
            {value.slice(0, 12)}
          </Button>
        </Tooltip>
      )}
    </CopyButton>
  );
}

export function SnapshotTable({ recording, snapshots, compared, onCompare }: SnapshotTableProps) {
  const restore = useRestoreSnapshot(recording.id);
  const tell = useUndoable(recording.id);
  const rows = snapshots.data;
  const bringBack = (snapshot: Snapshot): void =>
    restore.mutate(snapshot.id, {
      onSuccess: ({ changed, deleted, before }) =>
        tell(
          changed + deleted === 0
            ? `The labels are those of version ${snapshot.version} already.`
            : `Version ${snapshot.version} is back: ${formatCount(changed, "hand")} written, ${deleted} taken away.`,
          before,
        ),
      onError: (failure) => notifications.show({ color: "red", title: "Nothing was restored", message: failure.message }),
    });
  const verify = async (snapshot: Snapshot): Promise<void> => {
    try {
      const { is_intact, found } = await verifySnapshot(snapshot.id);
      notifications.show(
        is_intact
          ? { message: `Version ${snapshot.version} is intact: its SHA-256 matches.`, color: "teal" }
          : { message: found ? `Version ${snapshot.version} is damaged: its SHA-256 is now ${found.slice(0, 12)}… Restore the file from a backup.` : `The file of version ${snapshot.version} is missing. Restore it from a backup.`, color: "red", autoClose: false },
      );
    } catch (failure) {
      notifications.show({ color: "red", title: "Not verified", message: (failure as Error).message });
    }
  };

  return (
    <section aria-label="Snapshots">
      <Group justify="space-between" mb="sm">
        <Title order={2}>Snapshots</Title>
        <KeepForm recording={recording} next={(rows?.[0]?.version ?? 0) + 1} />
      </Group>
      {snapshots.error && !rows && <Failure what="The snapshots could not be loaded" error={snapshots.error} onRetry={() => void snapshots.refetch()} />}
      {snapshots.isPending && <Skeleton h={120} />}
      {rows?.length === 0 && (
        <Stack className="card" p="md" gap={4}>
          <Text fw={600}>No snapshot yet</Text>
          <Text size="sm" className="quiet">
            A snapshot keeps the labels as they are, with a hash: to compare with later, to cite in a report, or to restore. Imports and restores keep one before they change anything.
          </Text>
        </Stack>
      )}
      {rows && rows.length > 0 && (
        <div className={`card ${classes.frame}`}>
          <Table highlightOnHover verticalSpacing="xs" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th ta="right">Version</Table.Th>
                <Table.Th>Name</Table.Th>
                <Table.Th>SHA-256</Table.Th>
                <Table.Th ta="right">Hands</Table.Th>
                <Table.Th ta="right">Joints</Table.Th>
                <Table.Th ta="right">Kept</Table.Th>
                <Table.Th aria-label="Acts" />
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {rows.map((snapshot, index) => {
                const previous = rows[index + 1];
                return (
                  <Table.Tr key={snapshot.id} data-snapshot={snapshot.version} aria-current={snapshot.id === compared || undefined}>
                    <Table.Td ta="right" fw={600}>
                      {snapshot.version}
                    </Table.Td>
                    <Table.Td className={classes.name}>
                      {snapshot.name}
                      {snapshot.author && (
                        <Text size="xs" className="quiet">
                          {snapshot.author}
                        </Text>
                      )}
                    </Table.Td>
                    <Table.Td>
                      <Hash value={snapshot.content_hash} />
                    </Table.Td>
                    <Table.Td ta="right">{snapshot.item_count.toLocaleString("en")}</Table.Td>
                    <Table.Td ta="right">{snapshot.joint_count.toLocaleString("en")}</Table.Td>
                    <Table.Td ta="right">
                      <Text size="sm" className="quiet one-line">
                        {formatAgo(snapshot.created_at)}
                      </Text>
                    </Table.Td>
                    <Table.Td>
                      <Group gap={4} wrap="nowrap" justify="flex-end">
                        <Button size="compact-sm" variant={snapshot.id === compared ? "light" : "default"} onClick={() => onCompare(snapshot.id)} leftSection={<IconGitCompare size={14} aria-hidden />}>
                          Compare
                        </Button>
                        <Menu position="bottom-end">
                          <Menu.Target>
                            <ActionIcon aria-label={`More of version ${snapshot.version}`}>
                              <IconDots size={16} />
                            </ActionIcon>
                          </Menu.Target>
                          <Menu.Dropdown>
                            {previous && (
                              <Menu.Item onClick={() => onCompare(previous.id, snapshot.id)} leftSection={<IconGitCompare size={16} aria-hidden />}>
                                What changed since version {previous.version}
                              </Menu.Item>
                            )}
                            <Menu.Item component="a" href={snapshotFileUrl(snapshot.id)} download leftSection={<IconDownload size={16} aria-hidden />}>
                              Download its file
                            </Menu.Item>
                            <Menu.Item onClick={() => void verify(snapshot)} leftSection={<IconShieldCheck size={16} aria-hidden />}>
                              Verify its hash
                            </Menu.Item>
                            <For role="lead">
                              <Menu.Item onClick={() => bringBack(snapshot)} leftSection={<IconArrowBackUp size={16} aria-hidden />}>
                                Restore (can be undone)
                              </Menu.Item>
                            </For>
                          </Menu.Dropdown>
                        </Menu>
                      </Group>
                    </Table.Td>
                  </Table.Tr>
                );
              })}
            </Table.Tbody>
          </Table>
        </div>
      )}
    </section>
  );
}
