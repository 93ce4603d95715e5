import { ScrollArea, Tooltip } from "@mantine/core";
import { memo, useEffect, useRef } from "react";
import { selectJoint, switchHand } from "../../actions/annotate/select";
import { cycleVisibility } from "../../actions/annotate/visibility";
import type { Side } from "../../api/types";
import { describeSource } from "../../model/history";
import { HANDS, JOINTS, jointColor, jointLabel } from "../../model/joints";
import { decidedCount, statusOf, type JointStatus } from "../../model/pose";
import { activeKey, activePose, poseAt } from "../../state/annotator";
import { useHint } from "../../state/keys";
import { HandMark } from "../parts/HandBadge";
import { useAnnotating } from "./annotating";
import { useAnnotation } from "./reading";
import { SuggestLine } from "./SuggestLine";
import classes from "./JointsPanel.module.css";
import { largestError, Pixels, ViewErrors } from "./ViewErrors";
import { useTriangulation } from "./useTriangulation";

const STATUS: Record<JointStatus, { text: string; help: string }> = {
  unset: { text: "", help: "not marked yet" },
  visible: { text: "visible", help: "visible" },
  occluded: { text: "occluded", help: "hidden, place estimated" },
  outside: { text: "outside", help: "not in the image" },
};

/** Status as a shape: filled, hollow, crossed, or a dot where nothing is said yet. */
function StatusMark({ status, color }: { status: JointStatus; color: string }) {
  return (
    <svg width={14} height={14} viewBox="0 0 14 14" aria-hidden style={{ flex: "none" }}>
      {status === "visible" && <circle cx="7" cy="7" r="5" fill={color} stroke="var(--text-quiet)" strokeWidth="0.5" />}
      {status === "occluded" && <circle cx="7" cy="7" r="4.5" fill="none" stroke={color} strokeWidth="2" strokeDasharray="3 2" />}
      {status === "outside" && <path d="M3 3l8 8M11 3l-8 8" stroke={color} strokeWidth="2" fill="none" />}
      {status === "unset" && <circle cx="7" cy="7" r="2" fill="var(--text-quiet)" />}
    </svg>
  );
}

/** The line of a joint: what is known about it, and whether it comes next. */
const JointRow = memo(function JointRow({ joint, error }: { joint: number; error: number | null }) {
  const { act } = useAnnotating();
  const status = useAnnotation((state) => statusOf(activePose(state)[joint]));
  const source = useAnnotation((state) => activePose(state)[joint]?.from);
  const isActive = useAnnotation((state) => state.joint === joint);
  const row = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    if (isActive) row.current?.scrollIntoView({ block: "nearest" });
  }, [isActive]);
  const shown = isActive && status === "unset" ? "next" : STATUS[status].text;
  const from = source && status !== "unset" ? `accepted: ${describeSource(source)}` : undefined;
  const startsFinger = joint > 0 && (joint - 1) % 4 === 0;
  return (
    <button
      ref={row}
      type="button"
      className={classes.joint}
      data-active={isActive}
      data-first={startsFinger}
      data-status={status}
      aria-current={isActive ? "step" : undefined}
      aria-label={`${jointLabel(joint)}, ${STATUS[status].help}${from ? `, ${from}` : ""}`}
      title={from ?? (status === "outside" ? "Right click: back again" : undefined)}
      onClick={() => act(selectJoint, joint)}
      onContextMenu={(event) => {
        event.preventDefault();
        act(cycleVisibility, joint);
      }}
    >
      <StatusMark status={status} color={jointColor(joint)} />
      <span className="one-line">{jointLabel(joint)}</span>
      {from && <span className={classes.accepted} aria-hidden />}
      {error !== null && <Pixels error={error} />}
      <span className={classes.status} data-text={shown} aria-hidden />
    </button>
  );
});

/** One of the two hands, with how far it is; a click makes it the active one. */
function HandTab({ hand }: { hand: Side }) {
  const { act } = useAnnotating();
  const hint = useHint();
  const isActive = useAnnotation((state) => state.hand === hand);
  const count = useAnnotation((state) => decidedCount(isActive ? activePose(state) : poseAt(state, { ...activeKey(state), hand })));
  return (
    <Tooltip label={hint(`${hand} hand`, "hand.switch")}>
      <button type="button" role="tab" aria-selected={isActive} className={classes.hand} data-hand={hand} onClick={() => !isActive && act(switchHand, undefined)}>
        <HandMark hand={hand} size={12} />
        {hand}
        <span className={classes.count}>{count}/21</span>
      </button>
    </Tooltip>
  );
}

/** The joints, and how well the cameras agree about each. */
function MarkedJoints() {
  const { joints } = useTriangulation();
  return (
    <>
      <ScrollArea className={classes.list} type="auto" scrollbarSize={6}>
        {JOINTS.map((name, joint) => (
          <JointRow key={name} joint={joint} error={largestError(joints?.[joint])} />
        ))}
      </ScrollArea>
      <ViewErrors joints={joints} />
    </>
  );
}

/** The joints of the active hand. */
export function JointsPanel() {
  return (
    <div className={classes.panel} role="group" aria-label="Joints">
      <div className={classes.hands} role="tablist" aria-label="Hand">
        {HANDS.map((hand) => (
          <HandTab key={hand} hand={hand} />
        ))}
      </div>
      <MarkedJoints />
      <SuggestLine />
    </div>
  );
}
