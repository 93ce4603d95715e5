import { Button, Kbd, NumberInput, Text, Title } from "@mantine/core";
import { IconArrowBackUp, IconBracketsContainEnd, IconBracketsContainStart, IconCheck, IconX } from "@tabler/icons-react";
import type { StretchDecision } from "../../api/movingScans";
import { formatCount } from "../../model/format";
import { countFrames, sayStretch, type Stretch } from "../../model/stretch";
import { useKeyOf } from "../../state/keys";
import { KeyIcon } from "../parts/KeyIcon";
import classes from "./Moving.module.css";

interface StretchPanelProps {
  stretch: Stretch;
  most: number;
  onStretch: (stretch: Stretch) => void;
  onBegin: () => void;
  onEnd: () => void;
  /** Why nothing can be decided now; null when it can be. */
  obstacle: string | null;
  mayDecide: boolean;
  onDecide: (decision: "accept" | "reject") => void;
  /** Where one would register again. */
  here: number;
  onRerun: () => void;
  canUndo: boolean;
  onUndo: () => void;
  /** About this registration, the newest first. */
  decisions: readonly StretchDecision[];
  me: string;
  onTakeBack: (decision: StretchDecision) => void;
  onSeek: (frame: number) => void;
}

const WORDS = { accept: "accepted", reject: "rejected" } as const;

/** Frames from one to another: chosen, accepted, rejected, or registered again. */
export function StretchPanel(props: StretchPanelProps) {
  const { stretch, most, onStretch, onBegin, onEnd, obstacle, mayDecide, onDecide, here, onRerun, canUndo, onUndo, decisions, me, onTakeBack, onSeek } = props;
  const keyOf = useKeyOf();
  const standing = decisions.filter((one) => one.stands && one.decision !== "undo");
  const take = (bound: "first" | "last") => (value: number | string): void => {
    if (typeof value !== "number") return;
    const next = { ...stretch, [bound]: value };
    if (next.first <= next.last) onStretch(next);
  };
  return (
    <section aria-label="The stretch and the decision">
      <Title order={2} mb={4}>
        Stretch, {formatCount(countFrames(stretch), "frame")}
      </Title>
      <div className={classes.stretch}>
        <NumberInput size="xs" label="From frame" min={0} max={stretch.last} allowDecimal={false} value={stretch.first} onChange={take("first")} />
        <KeyIcon variant="default" size={30} label="The stretch begins here" told="It begins at the frame that is shown" action="moving.begin" onClick={onBegin}>
          <IconBracketsContainStart size={16} />
        </KeyIcon>
        <NumberInput size="xs" label="To frame" min={stretch.first} max={most} allowDecimal={false} value={stretch.last} onChange={take("last")} />
        <KeyIcon variant="default" size={30} label="The stretch ends here" told="It ends at the frame that is shown" action="moving.end" onClick={onEnd}>
          <IconBracketsContainEnd size={16} />
        </KeyIcon>
      </div>
      {obstacle && (
        <Text size="xs" className="quiet" mt={8}>
          {obstacle}
        </Text>
      )}
      <div className={classes.acts} role="group" aria-label="Decision" style={{ marginTop: 8 }}>
        {(["accept", "reject"] as const).map((kind) => (
          <button key={kind} type="button" className={classes.act} data-kind={kind} disabled={!mayDecide || obstacle !== null} onClick={() => onDecide(kind)}>
            {kind === "accept" ? <IconCheck size={18} aria-hidden /> : <IconX size={18} aria-hidden />}
            {kind === "accept" ? "Accept" : "Reject"}
            <Kbd size="xs" aria-hidden>
              {keyOf(`moving.${kind}`) || "–"}
            </Kbd>
          </button>
        ))}
        <button type="button" className={classes.act} data-kind="undo" disabled={!canUndo} title="Undo your last decision" onClick={onUndo}>
          <IconArrowBackUp size={18} aria-hidden />
          Undo
          <Kbd size="xs" aria-hidden>
            {keyOf("moving.undo") || "–"}
          </Kbd>
        </button>
      </div>
      {mayDecide && obstacle === null && (
        <Button size="xs" variant="default" fullWidth mt={8} onClick={onRerun}>
          Register again from frame {here} …
        </Button>
      )}
      {standing.length > 0 && (
        <ul className={classes.list} aria-label="Decisions about this registration" style={{ marginTop: 8 }}>
          {standing.map((one) => (
            <li key={one.id}>
              <button type="button" className={classes.jump} onClick={() => onSeek(one.first_frame)}>
                {sayStretch({ first: one.first_frame, last: one.last_frame })}
              </button>
              <span className="one-line" style={{ flex: 1 }}>
                {WORDS[one.decision as "accept"]} by {one.author_name}
              </span>
              {one.account_id === me && mayDecide && (
                <Button size="compact-xs" variant="subtle" onClick={() => onTakeBack(one)}>
                  Take back
                </Button>
              )}
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
