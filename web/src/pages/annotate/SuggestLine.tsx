import { Button, Text, Tooltip } from "@mantine/core";
import { formatCount } from "../../model/format";
import { JOINT_COUNT } from "../../model/joints";
import { decidedCount, keyText } from "../../model/pose";
import { SOURCES } from "../../model/suggestion";
import { activeKey } from "../../state/annotator";
import { useHint, useKeyOf } from "../../state/keys";
import { openJointsAt } from "../../state/suggestions";
import { useAnnotating } from "./annotating";
import classes from "./SuggestLine.module.css";
import { useSuggestions } from "./useSession";

/** Who suggests what for the active hand, and the button that takes it. */
export function SuggestLine() {
  const { session, state, pose, run, lock } = useAnnotating();
  const suggestions = useSuggestions(session);
  const hint = useHint();
  const keyOf = useKeyOf();
  const here = activeKey(state);
  const open = openJointsAt(suggestions, state, here);
  const count = open.filter((joint) => joint !== null).length;
  const bySource = suggestions.byPlace[keyText(here)];
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
            {decidedCount(pose) === JOINT_COUNT
              ? "Every joint of this hand is decided"
              : suggestions.hidden.size === SOURCES.length
                ? `Suggestions are hidden (${keyOf("suggestion.toggle")} shows them)`
                : "Nothing suggested for this hand yet"}
          </span>
        )}
      </Text>
      {count > 0 && (
        <Tooltip label={hint("Or one joint at a time", "suggestion.joint")}>
          <Button fullWidth size="compact-xs" variant="light" color="violet" disabled={lock !== null} onClick={() => run("suggestion.hand")} rightSection={<kbd className={classes.key}>{keyOf("suggestion.hand")}</kbd>}>
            Accept {formatCount(count, "joint")}
          </Button>
        </Tooltip>
      )}
    </div>
  );
}
