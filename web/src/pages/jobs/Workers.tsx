import { Badge, Group, Skeleton, Stack, Text, Title } from "@mantine/core";
import { IconAlertTriangle, IconCheck, IconMoon, IconPlayerPlay, IconServer, IconServerOff } from "@tabler/icons-react";
import { Link } from "react-router";
import { useActiveJobs, useWorkers } from "../../api/jobs";
import type { Job, Worker } from "../../api/types";
import { formatAgo, formatCount } from "../../model/format";
import classes from "./Workers.module.css";

const STATES: Record<Worker["state"], { color: string; icon: typeof IconCheck; label: string }> = {
  running: { color: "teal", icon: IconCheck, label: "ready" },
  silent: { color: "yellow", icon: IconMoon, label: "silent" },
  lost: { color: "red", icon: IconServerOff, label: "lost" },
  stopped: { color: "gray", icon: IconServer, label: "stopped" },
};

function WorkerCard({ worker, job }: { worker: Worker; job: Job | undefined }) {
  const { color, icon: Icon, label } = STATES[worker.state];
  const isBusy = worker.state === "running" && worker.job_id !== null;
  return (
    <li className={`card ${classes.worker}`} data-state={worker.state}>
      <Group justify="space-between" wrap="nowrap" gap="sm">
        <Text fw={600} className="one-line" title={`process ${worker.pid}`}>
          {worker.name}
        </Text>
        <Badge variant="light" color={isBusy ? "teal" : color} leftSection={isBusy ? <IconPlayerPlay size={12} aria-hidden /> : <Icon size={12} aria-hidden />} tt="none" style={{ flex: "none" }}>
          {isBusy ? "at work" : label}
        </Badge>
      </Group>
      <Text size="xs" className="quiet one-line">
        on {worker.host} · {worker.state === "running" ? "seen just now" : `last seen ${formatAgo(worker.last_seen_at)}`}
      </Text>
      <Text size="sm" className="one-line">
        {isBusy ? (
          <Link to={`/jobs/${worker.job_id}`} className={classes.link}>
            {job ? `${job.title}, ${Math.round(100 * job.progress)} %` : "a job"}
          </Link>
        ) : (
          <span className="quiet">{worker.state === "running" ? "waits for a job" : "others have taken over its work"}</span>
        )}
      </Text>
    </li>
  );
}

/** Who runs what, on which machine; those that ended on purpose are not worth a card, of those lost the last ones are. */
export function Workers() {
  const { data, error } = useWorkers();
  const active = useActiveJobs().data ?? [];
  if (error && !data) return <Text className="quiet">The workers could not be loaded: {error.message}</Text>;
  const alive = data?.filter((worker) => worker.state === "running") ?? [];
  const gone = data?.filter((worker) => worker.state === "silent" || worker.state === "lost").slice(0, 4) ?? [];
  const waiting = active.filter((job) => job.state === "queued").length;
  return (
    <section aria-label="Workers">
      <Group align="baseline" gap="md" mb="sm">
        <Title order={2}>Workers</Title>
        {data && <span className="quiet">{formatCount(alive.length, "worker")} ready or at work, {formatCount(waiting, "job")} waiting</span>}
      </Group>
      {data && alive.length === 0 && (
        <Group gap="sm" className="card" p="md" role="status" wrap="nowrap" mb="sm">
          <IconAlertTriangle size={20} color="var(--warn-text)" aria-hidden style={{ flex: "none" }} />
          <Text size="sm">No worker is running, so jobs wait. They are safe. Start one with “handloom worker” on any machine of the studio.</Text>
        </Group>
      )}
      {!data && <Skeleton height={88} radius="lg" />}
      <Stack component="ul" className={classes.list} gap={0}>
        {[...alive, ...gone].map((worker) => (
          <WorkerCard key={worker.id} worker={worker} job={active.find((job) => job.id === worker.job_id)} />
        ))}
      </Stack>
    </section>
  );
}
