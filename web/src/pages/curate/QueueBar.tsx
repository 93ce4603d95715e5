import { Button, Progress, Select, Text } from "@mantine/core";
import { IconUsers } from "@tabler/icons-react";
import { Link } from "react-router";
import { useQueueCounts, type Order, type Queue, type QueueChoice } from "../../api/registrations";
import { useScanCollections } from "../../api/scans";
import { formatLeft } from "../../model/format";
import { paceOf } from "../../model/pace";
import type { CurationState } from "../../state/curation";
import frame from "../hand3d/HandPage.module.css";
import classes from "./CuratePage.module.css";

const QUEUES: readonly (readonly [Queue, string])[] = [
  ["undecided", "Undecided"],
  ["flagged", "Doubted"],
  ["second", "Second review"],
  ["all", "All"],
];
const ORDERS: readonly (readonly [Order, string])[] = [
  ["likely_failures", "Likely failures first"],
  ["newest", "Newest first"],
];
const EVERY = "";

interface QueueBarProps {
  choice: QueueChoice;
  onChange: (patch: Partial<QueueChoice>) => void;
  state: CurationState;
}

/** Which queue, how far it is done, how fast, how long still. */
export function QueueBar({ choice, onChange, state }: QueueBarProps) {
  const counts = useQueueCounts(choice).data;
  const collections = useScanCollections().data ?? [];
  const here = new Set(state.steps.filter((step) => step.before === null).map((step) => step.registrationId)).size;
  const all = counts?.all ?? 0;
  const inQueue = counts?.[choice.queue] ?? 0;
  const left = choice.queue === "all" ? Math.max(0, counts ? counts.undecided - here : 0) : Math.max(0, inQueue - here);
  const done = counts ? Math.min(all, all - counts.undecided + (choice.queue === "undecided" || choice.queue === "all" ? here : 0)) : 0;
  const { perMinute, secondsLeft } = paceOf(state.times, left);
  return (
    <div className={frame.bar}>
      <Select
        size="xs"
        w={176}
        aria-label="Queue"
        allowDeselect={false}
        value={choice.queue}
        data={QUEUES.map(([value, label]) => ({ value, label: counts ? `${label} (${(value === choice.queue ? (value === "all" ? counts.all : left) : counts[value]).toLocaleString("en")})` : label }))}
        onChange={(value) => onChange({ queue: value as Queue })}
      />
      <Select
        size="xs"
        w={168}
        aria-label="Order"
        allowDeselect={false}
        value={choice.order}
        data={ORDERS.map(([value, label]) => ({ value, label }))}
        onChange={(value) => onChange({ order: value as Order })}
      />
      {(collections.length > 1 || choice.collection) && (
        <Select
          size="xs"
          w={176}
          aria-label="Collection"
          allowDeselect={false}
          searchable
          value={choice.collection ?? EVERY}
          data={[{ value: EVERY, label: "Every collection" }, ...collections.map(({ name }) => ({ value: name, label: name }))]}
          onChange={(value) => onChange({ collection: value || undefined })}
        />
      )}
      <div className={classes.progress} data-testid="curation-progress">
        {perMinute !== null && (
          <Text size="xs" span data-testid="pace">
            <strong>{perMinute.toFixed(0)}</strong> a minute
            {secondsLeft !== null && left > 0 ? ` · ${formatLeft(secondsLeft)}` : ""}
          </Text>
        )}
        {counts && (
          <Text size="xs" span className="quiet">
            {done.toLocaleString("en")} of {all.toLocaleString("en")} decided
          </Text>
        )}
        <Progress value={all > 0 ? (100 * done) / all : 0} w={128} aria-label={counts ? `${done} of ${all} decided` : "Counting …"} />
      </div>
      <Button size="xs" variant="default" component={Link} to="/curate/agreement" leftSection={<IconUsers size={14} aria-hidden />} style={{ flex: "none" }}>
        Agreement
      </Button>
    </div>
  );
}
