import { HANDS } from "../../model/joints";
import { isEmpty, keyText } from "../../model/pose";
import type { Action } from "../../state/annotator";

/** What was marked as the right hand is the left one and the other way round; one step for undo, both are saved. */
export const swapHands: Action = (state) => {
  const [right, left] = HANDS.map((hand) => keyText({ camera: state.camera, frame: state.frame, hand })) as [string, string];
  const { [right]: wasRight, [left]: wasLeft, ...others } = state.poses;
  if (isEmpty(wasRight) && isEmpty(wasLeft)) return state;
  const poses = { ...others, ...(wasLeft ? { [right]: wasLeft } : {}), ...(wasRight ? { [left]: wasRight } : {}) };
  return { ...state, poses, draft: null };
};
