import { Text, Tooltip } from "@mantine/core";
import { IconCheck, IconCloudOff, IconGitMerge, IconLoader2, IconLock, IconAlertTriangle } from "@tabler/icons-react";
import type { PlaceMode } from "../../actions/annotate/place";
import type { DepthImage } from "../../canvas/depth";
import { depthAt } from "../../canvas/depth";
import { formatCount } from "../../model/format";
import { jointLabel } from "../../model/joints";
import { statusOf, type Pose } from "../../model/pose";
import type { AnnotatorState } from "../../state/annotator";
import { useHint } from "../../state/keys";
import { usePointer, type PointerStore } from "../../state/pointer";
import type { SaveStatus } from "../../state/saveQueue";
import { useAnnotating } from "./annotating";
import classes from "./StatusLine.module.css";

function describeSaving(status: SaveStatus): { text: string; tone: "good" | "busy" | "bad"; icon: typeof IconCheck } {
  if (status.conflicts.size > 0) return { text: `${formatCount(status.conflicts.size, "change")} to settle`, tone: "bad", icon: IconGitMerge };
  if (status.refusals.size > 0) return { text: `not taken by the server, ${status.refusals.size} kept here`, tone: "bad", icon: IconAlertTriangle };
  if (status.isHeld) return { text: `log in to save, ${status.waiting} waiting`, tone: "bad", icon: IconLock };
  if (status.trouble) return { text: `held back, ${status.waiting} waiting`, tone: "bad", icon: IconAlertTriangle };
  if (status.isOffline) return { text: `offline, ${status.waiting} waiting`, tone: "bad", icon: IconCloudOff };
  if (status.waiting > 0 || status.isSending) return { text: "saving …", tone: "busy", icon: IconLoader2 };
  return { text: "saved", tone: "good", icon: IconCheck };
}

/** What the next click on the ground does. */
export function describeClick(state: AnnotatorState, pose: Pose, placeMode: PlaceMode): string {
  const name = `${state.hand} ${jointLabel(state.joint)}`;
  const status = statusOf(pose[state.joint]);
  const after = placeMode === "frame" ? ", then the next frame" : "";
  if (status === "unset") return `places the ${name}${after}`;
  return status === "outside" ? `places the ${name}, which is outside now` : `moves the ${name} here${after}`;
}

function Here({ pointer, depth }: { pointer: PointerStore; depth: DepthImage | null }) {
  const pixel = usePointer(pointer);
  if (!pixel) return null;
  const distance = depth && depthAt(depth, pixel.x, pixel.y);
  return (
    <>
      <span className={classes.figure} style={{ minWidth: 116 }}>
        {pixel.x.toFixed(1)}, {pixel.y.toFixed(1)} px
      </span>
      {depth && (
        <span className={classes.figure} style={{ minWidth: 72 }}>
          {distance === null ? "no depth" : `${distance.toFixed(4)} m`}
        </span>
      )}
    </>
  );
}

export function StatusLine() {
  const { state, pose, saving, pointer, pictures, lock, session, options } = useAnnotating();
  const hint = useHint();
  const { text, tone, icon: Icon } = describeSaving(saving);
  return (
    <div className={classes.line}>
      <Tooltip label={saving.isOffline ? hint("Kept in this browser; try now", "save.now") : "Every gesture is saved by itself"}>
        <button type="button" className={classes.saving} data-tone={tone} onClick={() => session.queue.flush()} aria-live="polite" data-testid="save-state">
          <Icon size={15} aria-hidden />
          {text}
        </button>
      </Tooltip>
      {saving.trouble && (
        <Text size="xs" c="var(--bad-text)" role="alert" truncate>
          {saving.trouble}
        </Text>
      )}
      {!saving.isKept && (
        <Text size="xs" c="var(--bad-text)">
          this browser keeps no copy: do not close the page before it is saved
        </Text>
      )}
      <span className={classes.next} data-testid="next-click">
        {lock ?? `Next click ${describeClick(state, pose, options.placeMode)}`}
      </span>
      <span className={classes.here}>
        <Here pointer={pointer} depth={pictures.depthImage} />
      </span>
    </div>
  );
}
