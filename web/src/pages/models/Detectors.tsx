import { ActionIcon, Button, FileButton, Group, Text, Title, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconDownload, IconTrash, IconUpload } from "@tabler/icons-react";
import { useRestore } from "../../api/bin";
import { detectorFileUrl, useDetectors, useRemoveDetector, useUploadDetector, type Detector } from "../../api/detectors";
import { formatBytes } from "../../model/format";
import type { Column } from "../parts/CardTable";
import { For } from "../parts/For";
import { intoBin } from "../parts/undo";
import { KeptTable } from "./KeptTable";

const COLUMNS: readonly Column<Detector>[] = [
  { head: "Looks at", width: 120, show: ({ looks_at: looksAt }) => (looksAt === "color" ? "colour" : "depth") },
  { head: "Trees", width: 80, isNumber: true, show: ({ trees }) => trees },
  { head: "Size", width: 96, isNumber: true, show: ({ byte_count: bytes }) => formatBytes(bytes) },
];

/** Fingertip detectors of the lab's own: tracking jobs offer them. */
export function Detectors() {
  const { data: detectors, error } = useDetectors();
  const adding = useUploadDetector();
  const removing = useRemoveDetector();
  const restore = useRestore();
  const add = (file: File | null): void => {
    if (!file) return;
    adding.mutate(file, {
      onSuccess: ({ name }) => notifications.show({ color: "teal", message: `“${name}” was added: the form of a tracking job offers it now.` }),
      onError: (failure) => notifications.show({ color: "red", title: "Not added", message: failure.message, autoClose: false }),
    });
  };
  const remove = ({ id, name }: Detector): void =>
    removing.mutate(
      id,
      intoBin(`“${name}”`, () => restore.mutateAsync({ kind: "detector", ids: [id] })),
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
        <KeptTable
          items={detectors}
          columns={COLUMNS}
          when="Added"
          actsWidth={96}
          acts={(detector) => (
            <>
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
            </>
          )}
        />
      )}
      <Text size="xs" className="quiet" mt={4}>
        {detectors?.length === 0 && "None of your own yet: tracking uses the one that comes with Handloom. "}
        “handloom train-detector” makes one from annotated recordings; tracking jobs with fingertips (S) among their terms can use it.
      </Text>
    </section>
  );
}
