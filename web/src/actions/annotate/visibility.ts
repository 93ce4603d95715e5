import { activePose, withActivePose, type Action } from "../../state/annotator";
import { hasPlace, isEmpty, nextOpenJoint, statusOf, withJoint, withStatus, type JointPoint, type JointStatus } from "../../model/pose";
import { clearHand } from "./clear";

const setStatus = (state: Parameters<Action>[0], joint: number, status: JointStatus): ReturnType<Action> => {
  const pose = activePose(state);
  const point = pose[joint];
  return point ? withActivePose(state, withJoint(pose, joint, withStatus(point, status))) : state;
};

/** What a right click makes of a joint: visible, occluded, outside, visible ...; outside without a place, it is open again. */
function cycled(point: JointPoint | undefined): JointStatus {
  switch (statusOf(point)) {
    case "visible":
      return "occluded";
    case "occluded":
      return "outside";
    case "outside":
      return point && hasPlace(point) ? "visible" : "unset";
    case "unset":
      return "unset";
  }
}

/** Right click on a joint, or on its line among the joints. */
export const cycleVisibility: Action<number> = (state, joint) => {
  const point = activePose(state)[joint];
  if (statusOf(point) === "unset") return state;
  const next = setStatus(state, joint, cycled(point));
  return { ...(isEmpty(activePose(next)) ? clearHand(next) : next), joint, isChosen: false };
};

/** Hidden but estimated, or visible again. */
export const toggleOccluded: Action = (state) => {
  const point = activePose(state)[state.joint];
  switch (statusOf(point)) {
    case "visible":
      return setStatus(state, state.joint, "occluded");
    case "occluded":
      return setStatus(state, state.joint, "visible");
    case "outside":
      return point && hasPlace(point) ? setStatus(state, state.joint, "occluded") : state;
    case "unset":
      return state;
  }
};

/** Not in the image, or back. A joint that was open is decided by this, so the next open one follows. */
export const toggleOutside: Action = (state) => {
  const point = activePose(state)[state.joint];
  switch (statusOf(point)) {
    case "outside":
      return setStatus(state, state.joint, point && hasPlace(point) ? "visible" : "unset");
    case "unset": {
      const next = setStatus(state, state.joint, "outside");
      return { ...next, joint: nextOpenJoint(activePose(next), state.joint), isChosen: false };
    }
    default:
      return setStatus(state, state.joint, "outside");
  }
};

/** Whatever nobody has decided of the hand is not in the image: a hand that is not there at all takes one key. */
export const restOutside: Action = (state) => {
  const pose = activePose(state);
  const rest = pose.map((point) => (statusOf(point) === "unset" ? withStatus(point, "outside") : point));
  return pose.some((point) => statusOf(point) === "unset") ? withActivePose(state, rest) : state;
};
