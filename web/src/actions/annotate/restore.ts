import { isEmpty, keyText, type Pose } from "../../model/pose";
import { activeKey, withActivePose, type Action } from "../../state/annotator";
import { clearHand } from "./clear";

/** An earlier version of a hand (`keyText`), if it is the active one still, is the newest again; nothing in between is lost, and it can be undone like any gesture. */
export const restorePose: Action<{ key: string; pose: Pose }> = (state, { key, pose }) => {
  if (keyText(activeKey(state)) !== key) return state;
  return isEmpty(pose) ? clearHand(state) : withActivePose(state, pose);
};
