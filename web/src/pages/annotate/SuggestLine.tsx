import { Button, Text, Tooltip } from "@mantine/core";
import { formatCount } from "../../model/format";
import { JOINT_COUNT } from "../../model/joints";
import { decidedCount, keyText, parseKey } from "../../model/pose";
import { SOURCES } from "../../model/suggestion";
import { activeKey, activePose } from "../../state/annotator";
import { useHint, useKeyOf } from "../../state/keys";
import { useAnnotating } from "./annotating";
import classes from "./SuggestLine.module.css";
import { useAnnotation, usePage, useShownCameras, useSuggestions } from "./reading";
import { useOpenJoints } from "./useOpenJoints";

/** Who suggests what for the active hand, and the button that takes it. */
export function SuggestLine() {
  const { run } = useAnnotating();
  const isLocked = usePage((page) => page.lock !== null);
  const areSeveral = useShownCameras().length > 1;
  const hint = useHint();
  const keyOf = useKeyOf();
  const key = useAnnotation((state) => keyText(activeKey(state)));
  const isDone = useAnnotation((state) => decidedCount(activePose(state)) === JOINT_COUNT);
  const areAllHidden = useSuggestions((state) => state.hidden.size === SOURCES.length);
  const open = useOpenJoints(parseKey(key));
  const count = open.filter((joint) => joint !== null).length;
  const bySource = useSuggestions((state) => state.byPlace[key]);
  const labels = SOURCES.filter((source) => open.some((joint) => joint?.source === source)).flatMap((source) => bySource?.[source]?.label ?? []);
  return (
    <div className={classes.line} data-testid="suggested-by" aria-live="polite">
      <Text size="xs" className={classes.text}>
        {count > 0 ? (
          <>
            <span className={classes.mark} aria-hidden /> Suggested by {labels.join(", ")}
          </>
        ) : (
          <span className="quiet">
            {isDone
              ? "All joints of this hand are marked"
              : areAllHidden
                ? `Suggestions are hidden (${keyOf("suggestion.toggle")} shows them)`
                : "Nothing suggested for this hand yet"}
          </span>
        )}
      </Text>
      {count > 0 && (
        <Tooltip label={hint("Or one joint at a time", "suggestion.joint")}>
          <Button fullWidth size="compact-xs" variant="light" color="violet" disabled={isLocked} onClick={() => run("suggestion.hand")} rightSection={<kbd className={classes.key}>{keyOf("suggestion.hand")}</kbd>}>
            Accept {formatCount(count, "joint")}
          </Button>
        </Tooltip>
      )}
      {count > 0 && areSeveral && (
        <Button fullWidth size="compact-xs" variant="subtle" color="violet" disabled={isLocked} onClick={() => run("suggestion.frame")} rightSection={<kbd className={classes.key}>{keyOf("suggestion.frame")}</kbd>}>
          Accept all in every picture
        </Button>
      )}
    </div>
  );
}
