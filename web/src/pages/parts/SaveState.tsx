import { Text, Tooltip } from "@mantine/core";
import { IconAlertTriangle, IconCheck, IconCloudOff, IconGitMerge, IconLoader2, IconLock } from "@tabler/icons-react";
import { formatCount } from "../../model/format";
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

function describe(status: SaveFacts): { text: string; tone: "good" | "busy" | "bad"; icon: typeof IconCheck } {
  if (status.conflicts) return { text: `${formatCount(status.conflicts, "change")} to settle`, tone: "bad", icon: IconGitMerge };
  if (status.refusals > 0) return { text: `not taken by the server, ${status.refusals} kept here`, tone: "bad", icon: IconAlertTriangle };
  if (status.isHeld) return { text: `log in to save, ${status.waiting} waiting`, tone: "bad", icon: IconLock };
  if (status.trouble) return { text: `held back, ${status.waiting} waiting`, tone: "bad", icon: IconAlertTriangle };
  if (status.isOffline) return { text: `offline, ${status.waiting} waiting`, tone: "bad", icon: IconCloudOff };
  if (status.waiting > 0 || status.isSending) return { text: "saving …", tone: "busy", icon: IconLoader2 };
  return { text: "saved", tone: "good", icon: IconCheck };
}

interface SaveStateProps {
  status: SaveFacts;
  /** "Every gesture is saved by itself". */
  what: string;
  /** The key that sends at once. */
  action: string;
  onFlush: () => void;
}

/** Saved, saving, or what waits and why; a click tries at once. */
export function SaveState({ status, what, action, onFlush }: SaveStateProps) {
  const hint = useHint();
  const { text, tone, icon: Icon } = describe(status);
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
      {!status.isKept && (
        <Text size="xs" c="var(--bad-text)">
          this browser keeps no copy: do not close the page before it is saved
        </Text>
      )}
    </>
  );
}
