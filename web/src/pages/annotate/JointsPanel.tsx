import { ScrollArea, Tooltip } from "@mantine/core";
import { useEffect, useRef } from "react";
import { selectJoint, switchHand } from "../../actions/annotate/select";
import { cycleVisibility } from "../../actions/annotate/visibility";
import { describeSource } from "../../model/history";
import { HANDS, JOINTS, jointColor, jointLabel } from "../../model/joints";
import { decidedCount, keyText, statusOf, type JointStatus } from "../../model/pose";
import { useHint } from "../../state/keys";
import { HandMark } from "../parts/HandBadge";
import { useAnnotating } from "./annotating";
import { SuggestLine } from "./SuggestLine";
import classes from "./JointsPanel.module.css";
import { JointError, ViewErrors } from "./ViewErrors";

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

/** The joints of the active hand, what is known about each, and which comes next. */
export function JointsPanel() {
  const { state, pose, act } = useAnnotating();
  const hint = useHint();
  const active = useRef<HTMLButtonElement>(null);
  useEffect(() => void active.current?.scrollIntoView({ block: "nearest" }), [state.joint]);
  return (
    <div className={classes.panel} role="group" aria-label="Joints">
      <div className={classes.hands} role="tablist" aria-label="Hand">
        {HANDS.map((hand) => {
          const count = decidedCount(hand === state.hand ? pose : state.poses[keyText({ camera: state.camera, frame: state.frame, hand })]);
          return (
            <Tooltip key={hand} label={hint(`${hand} hand`, "hand.switch")}>
              <button type="button" role="tab" aria-selected={hand === state.hand} className={classes.hand} data-hand={hand} onClick={() => hand !== state.hand && act(switchHand, undefined)}>
                <HandMark hand={hand} size={12} />
                {hand}
                <span className={classes.count}>{count}/21</span>
              </button>
            </Tooltip>
          );
        })}
      </div>
      <ScrollArea className={classes.list} type="auto" scrollbarSize={6}>
        {JOINTS.map((name, joint) => {
          const status = statusOf(pose[joint]);
          const isActive = joint === state.joint;
          const shown = isActive && status === "unset" ? "next" : STATUS[status].text;
          const source = pose[joint]?.from;
          const from = source && status !== "unset" ? `accepted: ${describeSource(source)}` : undefined;
          const startsFinger = joint > 0 && (joint - 1) % 4 === 0;
          return (
            <button
              key={name}
              ref={isActive ? active : null}
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
              <JointError joint={joint} />
              <span className={classes.status} data-text={shown} aria-hidden />
            </button>
          );
        })}
      </ScrollArea>
      <ViewErrors />
      <SuggestLine />
    </div>
  );
}
