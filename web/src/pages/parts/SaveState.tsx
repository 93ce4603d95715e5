import { Text, Tooltip } from "@mantine/core";
import { IconAlertTriangle, IconCheck, IconCloudOff, IconGitMerge, IconLoader2, IconLock } from "@tabler/icons-react";
import { useIsMutating } from "@tanstack/react-query";
import { Link } from "react-router";
import { formatCount } from "../../model/format";
import { useElsewhere, type Elsewhere, type Own } from "../../state/elsewhere";
import { useHint } from "../../state/keys";
import classes from "./SaveState.module.css";

export interface SaveFacts {
  readonly waiting: number;
  readonly isSending: boolean;
  readonly isOffline: boolean;
  readonly trouble: string;
  readonly isHeld: boolean;
  readonly isKept: boolean;
  readonly conflicts?: number;
  readonly refusals: number;
}

/** `isBusy`: some other change, such as a comment, is on its way to the server. */
function describe(status: SaveFacts, { mine, crops }: Elsewhere, isBusy: boolean): { text: string; tone: "good" | "busy" | "bad"; icon: typeof IconCheck } {
  if (status.conflicts) return { text: `${formatCount(status.conflicts, "change")} to settle`, tone: "bad", icon: IconGitMerge };
  if (status.refusals > 0) return { text: `not taken by the server, ${status.refusals} kept here`, tone: "bad", icon: IconAlertTriangle };
  if (status.isHeld) return { text: `log in to save, ${status.waiting} waiting`, tone: "bad", icon: IconLock };
  if (status.trouble) return { text: `held back, ${status.waiting} waiting`, tone: "bad", icon: IconAlertTriangle };
  if (status.isOffline) return { text: `offline, ${status.waiting} waiting`, tone: "bad", icon: IconCloudOff };
  if (status.waiting > 0 || status.isSending || isBusy) return { text: "saving …", tone: "busy", icon: IconLoader2 };
  if (mine > 0) return { text: `saved here, ${mine} waiting elsewhere`, tone: "busy", icon: IconLoader2 };
  if (crops > 0) return { text: `saved here, ${formatCount(crops, "crop")} not saved`, tone: "busy", icon: IconAlertTriangle };
  return { text: "saved", tone: "good", icon: IconCheck };
}

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
  const { text, tone, icon: Icon } = describe(status, elsewhere, isBusy);
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
