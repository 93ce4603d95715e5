import { Tooltip } from "@mantine/core";
import { goToFrame } from "../../actions/annotate/select";
import { useStore } from "../../state/useStore";
import { useAnnotating } from "./annotating";
import classes from "./StatusLine.module.css";

/** So many are named; the others are counted. */
const NAMED = 3;

/** Who else has the recording open, and at which frame; a click goes there. */
export function PeopleHere() {
  const { session, act } = useAnnotating();
  const people = useStore(session.people);
  if (people.length === 0) return null;
  return (
    <span className={classes.people} role="group" aria-label="Also here">
      {people.slice(0, NAMED).map(({ name, frame, hand, camera }) => (
        <Tooltip key={name} label={`${name} is at the ${hand} hand in frame ${frame} of ${camera}; click to go there`}>
          <button type="button" className={classes.person} onClick={() => act(goToFrame, frame)}>
            <span className={classes.initial} aria-hidden>
              {name.slice(0, 1).toUpperCase()}
            </span>
            <span className="one-line">
              {name} at {frame}
            </span>
          </button>
        </Tooltip>
      ))}
      {people.length > NAMED && <span>and {people.length - NAMED} more</span>}
    </span>
  );
}
