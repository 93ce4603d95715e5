import { Button, ScrollArea, Skeleton, Text } from "@mantine/core";
import { useEffect, useMemo } from "react";
import { restorePose } from "../../actions/annotate/restore";
import { useAnnotationHistory } from "../../api/annotations";
import { formatAgo, formatCount } from "../../model/format";
import { describeSources, readHistory, type HistoryEntry } from "../../model/history";
import { jointLabel } from "../../model/joints";
import { decidedCount, keyText } from "../../model/pose";
import { activeKey } from "../../state/annotator";
import { useAnnotating } from "./annotating";
import { useAnnotation, usePage, useSaving } from "./reading";
import classes from "./HistoryPanel.module.css";

function describeChange({ isDeleted, changed, sameAs, isNew }: HistoryEntry): string {
  if (isDeleted) return "cleared";
  if (sameAs !== null) return `as in revision ${sameAs} again`;
  const [only] = changed;
  if (changed.length === 1 && only !== undefined) return jointLabel(only);
  return `${formatCount(changed.length, "joint")} ${isNew ? "marked" : "changed"}`;
}

/** Every version of the active hand: look at one as a ghost, make it the newest again. */
export function HistoryPanel() {
  const { recording, replica, act, show } = useAnnotating();
  const frame = useAnnotation((state) => state.frame);
  const hand = useAnnotation((state) => state.hand);
  const key = useAnnotation((state) => keyText(activeKey(state)));
  const preview = usePage((page) => page.preview);
  const isLocked = usePage((page) => page.lock !== null);
  const savedAt = useSaving((saving) => saving.lastSavedAt);
  const { data, error } = useAnnotationHistory(recording.get().id, key, savedAt, replica);
  const entries = useMemo(() => readHistory(data ?? []), [data]);
  useEffect(() => () => show({ preview: null }), [show]);

  if (error) return <Text className={classes.empty}>The history could not be loaded. {error.message}</Text>;
  if (!data) {
    return (
      <div className={classes.empty} role="status" aria-label="Loading">
        {Array.from({ length: 4 }, (_, index) => (
          <Skeleton key={index} height={36} mb={8} />
        ))}
      </div>
    );
  }
  if (entries.length === 0) {
    return (
      <Text size="sm" className={classes.empty}>
        Nobody has marked the {hand} hand in frame {frame} yet. Every gesture on it will be listed here, and any version can be restored.
      </Text>
    );
  }
  const isShown = (entry: HistoryEntry): boolean => preview === entry.pose;
  return (
    <ScrollArea className={classes.list} type="auto" scrollbarSize={6}>
      <Text size="xs" className={classes.head}>
        {hand} hand, frame {frame}
      </Text>
      <ol className={classes.entries} aria-label="Versions, newest first">
        {entries.map((entry, index) => (
          <li key={entry.revision} className={classes.entry} data-shown={isShown(entry)}>
            <button type="button" className={classes.look} aria-pressed={isShown(entry)} disabled={index === 0} onClick={() => show({ preview: isShown(entry) ? null : entry.pose })}>
              <span className={classes.what}>{describeChange(entry)}</span>
              <span className={classes.who}>
                {entry.author}, {formatAgo(entry.at)}
                {describeSources(entry) !== "" && <span className={classes.from}>{describeSources(entry)}</span>}
              </span>
              <span className={classes.count}>{index === 0 ? "now" : `${decidedCount(entry.pose)}/21`}</span>
            </button>
            {isShown(entry) && (
              <Button
                size="compact-xs"
                m="0 12px 8px"
                disabled={isLocked}
                onClick={() => act(restorePose, { key, pose: entry.pose }) && show({ preview: null })}
              >
                Restore revision {entry.revision}
              </Button>
            )}
          </li>
        ))}
      </ol>
    </ScrollArea>
  );
}
