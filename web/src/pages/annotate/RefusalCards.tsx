import { Button, Text } from "@mantine/core";
import { parseKey } from "../../model/pose";
import { useAnnotating } from "./annotating";
import { useSaving } from "./reading";
import classes from "./Annotator.module.css";

/** What the server refuses to take, and what one can do about it. */
export function RefusalCards() {
  const { session } = useAnnotating();
  const refusals = useSaving((saving) => saving.refusals);
  return [...refusals].map(([key, reason]) => (
    <div key={key} className={`card ${classes.notice}`} role="alert">
      <Text size="sm" fw={600}>
        The server did not accept the {parseKey(key).hand} hand of frame {parseKey(key).frame}
      </Text>
      <Text size="xs" my={8}>
        {reason} Your version is kept in this browser; change it, or drop it.
      </Text>
      <Button size="xs" variant="default" onClick={() => session.queue.discard(key)}>
        Discard my version
      </Button>
    </div>
  ));
}
