import { Button, Group, Text } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { IconArrowsDiff } from "@tabler/icons-react";
import { Link } from "react-router";
import { isActive, useBulkAct } from "../../api/jobs";
import type { BulkAct, Job } from "../../api/types";
import { formatCount } from "../../model/format";
import classes from "./SelectionBar.module.css";
import { For } from "../parts/For";

const SAID: Record<BulkAct, string> = { cancel: "cancelled", retry: "queued again", resume: "resumed" };

/** What can be done with the jobs that are ticked. */
export function SelectionBar({ jobs, onClear }: { jobs: readonly Job[]; onClear: () => void }) {
  const bulk = useBulkAct();
  const active = jobs.filter(isActive);
  const ended = jobs.filter((job) => !isActive(job));
  const stopped = jobs.filter((job) => job.state === "failed" || job.state === "cancelled");
  const act = (what: BulkAct, on: readonly Job[]): void =>
    bulk.mutate(
      { act: what, ids: on.map((job) => job.id) },
      {
        onSuccess: ({ jobs: done, refused }) => {
          onClear();
          notifications.show({
            color: refused.length > 0 ? "yellow" : "teal",
            message: `${formatCount(done.length, "job")} ${SAID[what]}.${refused.length > 0 ? ` ${refused.length} not: ${refused[0]?.detail}` : ""}`,
          });
        },
        onError: (error) => notifications.show({ color: "red", message: `${error.message} Nothing was changed.` }),
      },
    );
  return (
    <Group className={classes.bar} gap="sm" role="region" aria-label="Chosen jobs">
      <Text fw={600} size="sm" role="status">
        {formatCount(jobs.length, "job")} chosen
      </Text>
      <For role="reviewer">
        {active.length > 0 && (
          <Button size="xs" variant="default" loading={bulk.isPending} onClick={() => act("cancel", active)}>
            Cancel {active.length}
          </Button>
        )}
        {stopped.length > 0 && (
          <Button size="xs" variant="default" loading={bulk.isPending} onClick={() => act("resume", stopped)}>
            Resume {stopped.length}
          </Button>
        )}
        {ended.length > 0 && (
          <Button size="xs" variant="default" loading={bulk.isPending} onClick={() => act("retry", ended)}>
            Run {ended.length} again
          </Button>
        )}
      </For>
      {jobs.length === 2 && (
        <Button size="xs" component={Link} to={`/jobs/compare?a=${jobs[1]?.id}&b=${jobs[0]?.id}`} leftSection={<IconArrowsDiff size={14} aria-hidden />}>
          Compare
        </Button>
      )}
      <Button size="xs" variant="subtle" onClick={onClear}>
        Choose none
      </Button>
    </Group>
  );
}
