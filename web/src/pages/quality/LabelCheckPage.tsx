import { Button, Chip, Group, SegmentedControl, Skeleton, Text, Title } from "@mantine/core";
import { IconChecks } from "@tabler/icons-react";
import { Link, useParams, useSearchParams } from "react-router";
import { useDismissal, useFlagPages } from "../../api/flags";
import { useRecording } from "../../api/recordings";
import { KIND_NAMES, KINDS } from "../../model/flag";
import { formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { useTitle } from "../parts/useTitle";
import { CheckedList } from "./CheckedList";
import { FlagItem } from "./FlagItem";
import classes from "./LabelCheck.module.css";

/** Labels of a recording that look wrong, the worst first. */
export default function LabelCheckPage() {
  const { recordingId = "" } = useParams();
  const [address, setAddress] = useSearchParams();
  const kind = KINDS.find((one) => one === address.get("kind")) ?? null;
  const isDismissed = address.get("show") === "right";
  const recording = useRecording(recordingId);
  const pages = useFlagPages(recordingId, kind, isDismissed);
  const dismissal = useDismissal(recordingId);
  useTitle("Label check");

  const choose = (change: Record<string, string | null>): void => {
    const next = new URLSearchParams(address);
    for (const [name, value] of Object.entries(change)) {
      if (value === null) next.delete(name);
      else next.set(name, value);
    }
    setAddress(next, { replace: true });
  };

  const error = recording.error ?? pages.error ?? null;
  if (error && (!recording.data || !pages.data)) {
    return <Failure what="The label check could not be loaded" error={error} safe="Labels are as they were." onRetry={() => void Promise.all([recording.refetch(), pages.refetch()])} />;
  }
  const flags = pages.data?.pages.flatMap((page) => page.items) ?? [];
  const first = pages.data?.pages[0];
  const open = first ? Object.values(first.counts).reduce((sum, count) => sum + (count ?? 0), 0) : 0;
  const shot = recording.data;
  return (
    <div className="page">
      <Group justify="space-between" mb="sm">
        <div>
          <Text size="sm" className="quiet">
            <Link to={`/recordings/${recordingId}`} className={classes.back}>
              {shot?.name ?? "Recording"}
            </Link>
          </Text>
          <Title order={1}>Label check</Title>
        </div>
        <SegmentedControl
          size="xs"
          aria-label="Which flags"
          value={isDismissed ? "right" : "open"}
          onChange={(value) => choose({ show: value === "right" ? "right" : null })}
          data={[
            { value: "open", label: first ? `To look at (${open})` : "To look at" },
            { value: "right", label: first ? `Found right (${first.dismissed})` : "Found right" },
          ]}
        />
      </Group>
      <Chip.Group value={kind ?? ""} onChange={(value) => choose({ kind: String(value) || null })}>
        <Group gap={8} mb="md">
          <Chip size="xs" value="">
            All kinds
          </Chip>
          {KINDS.filter((one) => one === kind || isDismissed || (first?.counts[one] ?? 0) > 0).map((one) => (
            <Chip key={one} size="xs" value={one}>
              {KIND_NAMES[one]}
              {isDismissed ? "" : ` ${first?.counts[one] ?? 0}`}
            </Chip>
          ))}
        </Group>
      </Chip.Group>
      {dismissal.error && (
        <Text size="sm" c="var(--bad-text)" mb="sm" role="alert">
          {dismissal.error.message}
        </Text>
      )}
      {(!first || !shot) && (
        <div className={classes.grid} role="status" aria-label="Checking the labels">
          {Array.from({ length: 8 }, (_, index) => (
            <Skeleton key={index} height={292} radius="lg" />
          ))}
        </div>
      )}
      {first && shot && flags.length === 0 && (
        <EmptyState
          icon={<IconChecks size={48} stroke={1.25} />}
          title={isDismissed ? "Nothing was put away" : first.checked.labels === 0 ? "Nothing is labelled yet" : "No label looks wrong to what could be checked"}
          action={
            <Button variant="default" component={Link} to={`/recordings/${recordingId}/annotate`}>
              Annotate
            </Button>
          }
        >
          {isDismissed
            ? "Flags that somebody looked at and found right are kept here, and can be brought back."
            : "Every label is checked whenever it changes. What looks wrong appears here, the worst first; below is what each check could look at, and what it lacks."}
        </EmptyState>
      )}
      {shot && flags.length > 0 && (
        <ul className={classes.grid} aria-label="Flagged labels" aria-busy={pages.isPlaceholderData} style={pages.isPlaceholderData ? { opacity: 0.6 } : undefined}>
          {flags.map((flag) => (
            <FlagItem
              key={`${flag.kind}|${flag.camera}|${flag.frame}|${flag.hand}`}
              recording={shot}
              flag={flag}
              isDismissed={isDismissed}
              isBusy={dismissal.isPending || pages.isPlaceholderData}
              onJudge={() => dismissal.mutate({ flag, isRight: !isDismissed })}
            />
          ))}
        </ul>
      )}
      {pages.hasNextPage && (
        <Group justify="center" mt="md">
          <Button variant="default" loading={pages.isFetchingNextPage} onClick={() => void pages.fetchNextPage()}>
            Show more of {formatCount(open, "flag")}
          </Button>
        </Group>
      )}
      {first && !isDismissed && first.checked.labels > 0 && <CheckedList checked={first.checked} />}
    </div>
  );
}
