import { isEmpty, type Pose } from "../../model/pose";
import { withActivePose, type Action } from "../../state/annotator";
import { clearHand } from "./clear";

/** An earlier version of the active hand is the newest again; nothing in between is lost, and it can be undone like any gesture. */
export const restorePose: Action<Pose> = (state, pose) => (isEmpty(pose) ? clearHand(state) : withActivePose(state, pose));
