import { Text } from "@mantine/core";
import type { FlagPage } from "../../api/types";
import { KIND_NAMES, KINDS } from "../../model/flag";
import { formatCount } from "../../model/format";
import classes from "./LabelCheck.module.css";

/** What the checks could look at, and what they lack for the rest: an all-clear says no more than this. */
export function CheckedList({ checked }: { checked: FlagPage["checked"] }) {
  const { labels, frames, track, checks, is_behind: isBehind } = checked;
  return (
    <section className={`card ${classes.checked}`} aria-label="What was checked">
      <Text size="sm" fw={600}>
        Checked: {formatCount(labels, "hand")} in {formatCount(frames, "frame")}
        {track ? `, against ${track}` : ", against no track"}
      </Text>
      {isBehind && (
        <Text size="xs" c="var(--warn-text)" role="status">
          Labels have changed since. They are checked again in a moment.
        </Text>
      )}
      <table className={classes.checks}>
        <tbody>
          {KINDS.flatMap((kind) => checks.filter((one) => one.kind === kind)).map((one) => (
            <tr key={one.kind}>
              <th scope="row">{KIND_NAMES[one.kind]}</th>
              <td>{one.labels === labels ? "all" : one.labels === 0 ? "none" : `${one.labels} of ${labels}`}</td>
              <td className="quiet">{one.missing}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
