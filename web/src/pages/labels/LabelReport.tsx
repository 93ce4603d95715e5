import { Button, Group, List, Radio, ScrollArea, Stack, Table, Text } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconCircleCheck } from "@tabler/icons-react";
import { useState } from "react";
import { ApiError } from "../../api/client";
import { useImportLabels, type LabelImportReport, type LabelUpload, type Policy } from "../../api/labels";
import type { Recording } from "../../api/types";
import { formatCount } from "../../model/format";
import { Sentences } from "../parts/Sentences";
import { ChangeCells, CHANGE_HEADS } from "./ChangeCells";
import { useUndoable } from "./useUndoable";

interface LabelReportProps {
  recording: Recording;
  report: LabelImportReport;
  upload: LabelUpload;
  onDone: () => void;
  /** Somebody changed the labels since: look again. */
  onStale: () => void;
}

/** What was found in files of labels; nothing is stored before it is confirmed. */
export function LabelReport({ recording, report, upload, onDone, onStale }: LabelReportProps) {
  const [policy, setPolicy] = useState<Policy>("keep");
  const take = useImportLabels(recording.id);
  const tell = useUndoable(recording.id);
  const found = report.recordings[0];
  if (!found) return null;
  const count = found.new + (policy === "replace" ? found.conflict_count : 0);

  const confirm = (): void =>
    take.mutate(
      { ...upload, check: report.check ?? "", policy },
      {
        onSuccess: ({ recordings: [done] }) => {
          if (done?.before) tell(`${formatCount(done.added, "hand")} added, ${done.replaced} replaced.`, done.before);
          onDone();
        },
        onError: (failure) => {
          if (failure instanceof ApiError && failure.status === 409) onStale();
          notifications.show({ color: "red", title: "Nothing was imported", message: failure.message });
        },
      },
    );

  return (
    <Stack gap="sm" data-testid="label-report">
      <Text size="sm" fw={600}>
        Read as {report.title}
      </Text>
      <Sentences title="This cannot be imported" sentences={report.problems} isProblem />
      <Sentences title="Worth knowing" sentences={report.warnings} isProblem={false} />
      <List size="sm" spacing={4}>
        <List.Item>{formatCount(found.new, "hand")} where nothing is labelled yet</List.Item>
        <List.Item>{found.same} already labelled the same</List.Item>
        <List.Item>{found.conflict_count} labelled otherwise</List.Item>
        {found.locked > 0 && (
          <List.Item>
            {found.locked} locked, left as they are: {found.reasons.join(" ")}
          </List.Item>
        )}
      </List>
      {found.conflict_count > 0 && (
        <>
          <ScrollArea.Autosize mah={200} type="auto">
            <Table verticalSpacing={4} horizontalSpacing="xs" fz="xs">
              <Table.Thead>
                <Table.Tr>{CHANGE_HEADS}</Table.Tr>
              </Table.Thead>
              <Table.Tbody>
                {found.conflicts.map((change) => (
                  <Table.Tr key={`${change.frame} ${change.camera} ${change.hand}`}>
                    <ChangeCells change={change} />
                  </Table.Tr>
                ))}
              </Table.Tbody>
            </Table>
          </ScrollArea.Autosize>
          <Radio.Group label="Hands with other labels" value={policy} onChange={(value) => setPolicy(value)}>
            <Stack gap={4} mt={4}>
              <Radio value="keep" label="Keep what is here" size="sm" />
              <Radio value="replace" label="Replace by the file's, as new revisions" size="sm" />
            </Stack>
          </Radio.Group>
        </>
      )}
      <Group gap="sm">
        <Button onClick={confirm} loading={take.isPending} disabled={!report.check || count === 0} leftSection={<IconCircleCheck size={16} aria-hidden />}>
          {count > 0 ? `Import ${formatCount(count, "hand")}` : "Nothing to import"}
        </Button>
        <Button variant="default" onClick={onDone}>
          Discard
        </Button>
      </Group>
    </Stack>
  );
}
