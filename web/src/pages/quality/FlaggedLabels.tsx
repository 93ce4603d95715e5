import { Button, Chip, Group, Skeleton, Text } from "@mantine/core";
import { IconChecks } from "@tabler/icons-react";
import { Link } from "react-router";
import { useDismissal, type useFlagPages } from "../../api/flags";
import type { Flag, Recording } from "../../api/types";
import { countOpen, KIND_NAMES, KINDS } from "../../model/flag";
import { formatCount } from "../../model/format";
import { EmptyState } from "../parts/EmptyState";
import { CheckedList } from "./CheckedList";
import { FlagItem } from "./FlagItem";
import classes from "./LabelCheck.module.css";

interface FlaggedLabelsProps {
  recordingId: string;
  /** Undefined while it is fetched. */
  recording: Recording | undefined;
  pages: ReturnType<typeof useFlagPages>;
  /** Only these; null: all. */
  kind: Flag["kind"] | null;
  isDismissed: boolean;
  onKind: (kind: string | null) => void;
}

/** Labels that look wrong, or those that were found right, and what was checked. */
export function FlaggedLabels({ recordingId, recording: shot, pages, kind, isDismissed, onKind }: FlaggedLabelsProps) {
  const dismissal = useDismissal(recordingId);
  const flags = pages.data?.pages.flatMap((page) => page.items) ?? [];
  const first = pages.data?.pages[0];
  return (
    <>
      <Chip.Group value={kind ?? ""} onChange={(value) => onKind(String(value) || null)}>
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
          title={isDismissed ? "Nothing was dismissed" : first.checked.labels === 0 ? "Nothing is labelled yet" : "No check found a wrong label"}
          action={
            <Button variant="default" component={Link} to={`/recordings/${recordingId}/annotate`}>
              Annotate
            </Button>
          }
        >
          {isDismissed
            ? "Flags that somebody dismissed are kept here, and can be restored."
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
            Show more of {formatCount(first ? countOpen(first) : 0, "flag")}
          </Button>
        </Group>
      )}
      {first && !isDismissed && first.checked.labels > 0 && <CheckedList checked={first.checked} />}
    </>
  );
}
