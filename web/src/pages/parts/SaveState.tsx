import { Text, Tooltip } from "@mantine/core";
import { IconAlertTriangle, IconCheck, IconCloudOff, IconGitMerge, IconLoader2, IconLock } from "@tabler/icons-react";
import { useIsMutating } from "@tanstack/react-query";
import { Link } from "react-router";
import { formatCount } from "../../model/format";
import { describeSaving, type SaveFacts, type SaveSign } from "../../model/saveWords";
import { useElsewhere, type Own } from "../../state/elsewhere";
import { useHint } from "../../state/keys";
import classes from "./SaveState.module.css";

const ICONS: Record<SaveSign, typeof IconCheck> = { settle: IconGitMerge, warning: IconAlertTriangle, lock: IconLock, offline: IconCloudOff, busy: IconLoader2, saved: IconCheck };

interface SaveStateProps {
  status: SaveFacts;
  /** What `status` counts; whatever else waits in this browser is said beside it. */
  own: Own;
  /** "Every gesture is saved by itself". */
  what: string;
  /** The key that sends at once. */
  action: string;
  onFlush: () => void;
}

/** Saved, saving, or what waits and why; a click tries at once. */
export function SaveState({ status, own, what, action, onFlush }: SaveStateProps) {
  const hint = useHint();
  const elsewhere = useElsewhere(own);
  const isBusy = useIsMutating() > 0;
  const { text, tone, sign } = describeSaving(status, elsewhere, isBusy);
  const Icon = ICONS[sign];
  return (
    <>
      <Tooltip label={status.isOffline ? hint("Kept in this browser; try now", action) : what}>
        <button type="button" className={classes.saving} data-tone={tone} onClick={onFlush} aria-live="polite" data-testid="save-state">
          <Icon size={15} aria-hidden />
          {text}
        </button>
      </Tooltip>
      {status.trouble && (
        <Text size="xs" c="var(--bad-text)" role="alert" truncate>
          {status.trouble}
        </Text>
      )}
      {elsewhere.mine > 0 && elsewhere.recording && (
        <Link className={classes.note} to={`/recordings/${elsewhere.recording}/annotate`}>
          Open where it waits
        </Link>
      )}
      {elsewhere.others.map(({ name, count }) => (
        <span key={name} className={classes.note} data-testid="waits-for">
          {formatCount(count, "gesture")} of {name} {count === 1 ? "waits" : "wait"} for {name}
        </span>
      ))}
      {!status.isKept && (
        <Text size="xs" c="var(--bad-text)">
          this browser keeps no copy: do not close the page before it is saved
        </Text>
      )}
    </>
  );
}
