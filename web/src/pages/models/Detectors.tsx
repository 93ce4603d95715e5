import { ActionIcon, Button, FileButton, Group, Table, Text, Title, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconDownload, IconTrash, IconUpload } from "@tabler/icons-react";
import { detectorFileUrl, useDetectors, useRemoveDetector, useUploadDetector, type Detector } from "../../api/detectors";
import { formatAgo, formatBytes } from "../../model/format";
import { For } from "../parts/For";
import { offerUndo, tellFailure } from "../projects/offerUndo";
import classes from "./Models.module.css";

/** Fingertip detectors of the lab's own: tracking jobs offer them. */
export function Detectors() {
  const { data: detectors, error } = useDetectors();
  const adding = useUploadDetector();
  const removing = useRemoveDetector();
  const add = (file: File | null): void => {
    if (!file) return;
    adding.mutate(file, {
      onSuccess: ({ name }) => notifications.show({ color: "teal", message: `“${name}” was added: the form of a tracking job offers it now.` }),
      onError: (failure) => notifications.show({ color: "red", title: "Not added", message: failure.message, autoClose: false }),
    });
  };
  const remove = ({ id, name }: Detector): void =>
    removing.mutate(
      { id, isBack: false },
      { onSuccess: () => offerUndo(`“${name}” was moved to the bin.`, () => removing.mutateAsync({ id, isBack: true })), onError: tellFailure },
    );
  return (
    <section aria-label="Fingertip detectors">
      <Group justify="space-between" mb="sm" wrap="nowrap">
        <Title order={2}>Fingertip detectors</Title>
        <For role="lead">
          <FileButton accept=".npz" onChange={add}>
            {(props) => (
              <Button {...props} variant="default" size="compact-sm" loading={adding.isPending} leftSection={<IconUpload size={14} aria-hidden />}>
                Add detector …
              </Button>
            )}
          </FileButton>
        </For>
      </Group>
      {error && !detectors && (
        <Text size="sm" c="red" role="alert">
          The fingertip detectors could not be loaded: {error.message}
        </Text>
      )}
      {detectors && detectors.length > 0 && (
        <div className={`card ${classes.frame}`}>
          <Table verticalSpacing="xs" horizontalSpacing="md">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Name</Table.Th>
                <Table.Th w={120}>Looks at</Table.Th>
                <Table.Th w={80} ta="right">
                  Trees
                </Table.Th>
                <Table.Th w={96} ta="right">
                  Size
                </Table.Th>
                <Table.Th w={128}>SHA-256</Table.Th>
                <Table.Th w={128} ta="right">
                  Added
                </Table.Th>
                <Table.Th w={96} aria-label="Acts" />
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {detectors.map((detector) => (
                <Table.Tr key={detector.id}>
                  <Table.Td className={classes.cell} title={detector.name}>
                    {detector.name}
                  </Table.Td>
                  <Table.Td>{detector.looks_at === "color" ? "colour" : "depth"}</Table.Td>
                  <Table.Td ta="right">{detector.trees}</Table.Td>
                  <Table.Td ta="right">{formatBytes(detector.byte_count)}</Table.Td>
                  <Table.Td className={classes.cell} title={detector.digest} style={{ fontFamily: "var(--mantine-font-family-monospace)", fontSize: 12 }}>
                    {detector.digest.slice(0, 12)}
                  </Table.Td>
                  <Table.Td ta="right" className="quiet">
                    {formatAgo(detector.created_at)}
                  </Table.Td>
                  <Table.Td>
                    <Group gap={4} justify="flex-end" wrap="nowrap">
                      <Tooltip label="Download its file">
                        <ActionIcon component="a" href={detectorFileUrl(detector.id)} download aria-label={`Download ${detector.name}`}>
                          <IconDownload size={16} />
                        </ActionIcon>
                      </Tooltip>
                      <For role="lead">
                        <Tooltip label="Delete (can be undone)">
                          <ActionIcon onClick={() => remove(detector)} aria-label={`Delete ${detector.name}`}>
                            <IconTrash size={16} />
                          </ActionIcon>
                        </Tooltip>
                      </For>
                    </Group>
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
      <Text size="xs" className="quiet" mt={4}>
        {detectors?.length === 0 && "None of your own yet: tracking uses the one that comes with Handloom. "}
        “handloom train-detector” makes one from annotated recordings; tracking jobs with fingertips (S) among their terms can use it.
      </Text>
    </section>
  );
}
