import { Button, Group, Progress, Stack, Text, Title } from "@mantine/core";
import { useBatches, useBulkAct } from "../../api/jobs";
import { fetchAll } from "../../api/recordings";
import type { Batch, Job } from "../../api/types";
import { formatAgo, formatCount, formatLeft } from "../../model/format";
import { For } from "../parts/For";

const SHOWN = 3;

/** "2 running, 3 waiting, 1 failed". */
function countsOf(batch: Batch): string {
  const words = { running: "running", queued: "waiting", succeeded: "done", failed: "failed", cancelled: "cancelled" } as const;
  return Object.entries(words)
    .filter(([state]) => (batch.states[state as keyof typeof words] ?? 0) > 0)
    .map(([state, word]) => `${batch.states[state as keyof typeof words]} ${word}`)
    .join(", ");
}

function BatchRow({ batch, isChosen, onChoose }: { batch: Batch; isChosen: boolean; onChoose: () => void }) {
  const act = useBulkAct();
  const failed = (batch.states.failed ?? 0) + (batch.states.cancelled ?? 0);
  const actOn = async (what: "cancel" | "retry", states: string[]): Promise<void> => {
    const jobs = await fetchAll<Job>("/jobs", { batch_id: batch.id, state: states });
    const replaced = new Set(jobs.map((job) => job.retry_of));
    act.mutate({ act: what, ids: jobs.filter((job) => !replaced.has(job.id)).map((job) => job.id) });
  };
  return (
    <div className="card" style={{ padding: "12px 16px" }}>
      <Group wrap="nowrap" gap="md">
        <div style={{ flex: "1 0 min(240px, 100%)", minWidth: 0 }}>
          <Text fw={600} className="one-line">
            {formatCount(batch.total, "recording")}
          </Text>
          <Text size="xs" className="quiet one-line">
            {countsOf(batch)} · started {formatAgo(batch.created_at)}
            {batch.created_by_name ? ` by ${batch.created_by_name}` : ""}
            {batch.seconds_left !== null ? ` · ${formatLeft(batch.seconds_left)}` : ""}
          </Text>
        </div>
        <Progress.Root w={240} aria-label={`${Math.round(100 * batch.progress)} % of the batch done`}>
          <Progress.Section value={100 * batch.progress} color={failed > 0 ? "yellow" : "teal"} aria-label="Part of the batch that is done" />
        </Progress.Root>
        <Text size="sm" fw={600} w={48} ta="right">
          {Math.round(100 * batch.progress)} %
        </Text>
        <Button size="xs" variant={isChosen ? "filled" : "default"} aria-pressed={isChosen} onClick={onChoose}>
          {isChosen ? "Show all jobs" : "Show its jobs"}
        </Button>
        <For role="reviewer">
          {!batch.ended_at && (
            <Button size="xs" variant="default" loading={act.isPending} onClick={() => void actOn("cancel", ["queued", "running"])}>
              Cancel the batch
            </Button>
          )}
          {batch.ended_at && failed > 0 && (
            <Button size="xs" variant="default" loading={act.isPending} onClick={() => void actOn("retry", ["failed", "cancelled"])}>
              Try {failed} again
            </Button>
          )}
        </For>
      </Group>
    </div>
  );
}

/** Batches that go on, and the newest that ended. */
export function Batches({ chosen, onChoose }: { chosen: string | undefined; onChoose: (id: string | undefined) => void }) {
  const { data } = useBatches();
  const shown = data?.filter((batch, place) => place < SHOWN || !batch.ended_at || batch.id === chosen) ?? [];
  if (shown.length === 0) return null;
  return (
    <Stack gap="sm" component="section" aria-label="Batches">
      <Title order={2}>Batches</Title>
      {shown.map((batch) => (
        <BatchRow key={batch.id} batch={batch} isChosen={batch.id === chosen} onChoose={() => onChoose(batch.id === chosen ? undefined : batch.id)} />
      ))}
    </Stack>
  );
}
