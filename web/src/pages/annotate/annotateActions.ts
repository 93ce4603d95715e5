import { acceptBetween } from "../../actions/annotate/acceptBetween";
import { bringPose, annotatedFrames } from "../../actions/annotate/bring";
import { clearHand, clearJoint } from "../../actions/annotate/clear";
import { nudgeJoint } from "../../actions/annotate/move";
import { placeBeside } from "../../actions/annotate/place";
import { propagateOn } from "../../actions/annotate/propagate";
import { goToFrame, selectCamera, selectFinger, stepJoint, switchHand } from "../../actions/annotate/select";
import { swapHands } from "../../actions/annotate/swap";
import { restOutside, toggleOccluded, toggleOutside } from "../../actions/annotate/visibility";
import { keyFramesOf, spanAt } from "../../model/interpolation";
import { isEmpty, keyText } from "../../model/pose";
import { activeKey, poseAt, type Action, type AnnotatorState } from "../../state/annotator";
import type { Actions, Annotating } from "./annotating";

const NUDGES = {
  "nudge.left": { x: -0.5, y: 0 },
  "nudge.right": { x: 0.5, y: 0 },
  "nudge.up": { x: 0, y: -0.5 },
  "nudge.down": { x: 0, y: 0.5 },
  "push.left": { x: -5, y: 0 },
  "push.right": { x: 5, y: 0 },
  "push.up": { x: 0, y: -5 },
  "push.down": { x: 0, y: 5 },
} as const;

const FINGER_KEYS = ["wrist", "thumb", "index", "middle", "ring", "little"] as const;

/** Everything of the key map that only changes the annotator's state, by its id. */
export function annotateActions({ session, recording, act }: Annotating): Actions {
  const { store } = session;
  const simple = (action: Action) => () => act(action, undefined);
  const toFrame = (pick: (state: AnnotatorState) => number | undefined) => () => {
    const frame = pick(store.get());
    if (frame !== undefined) act(goToFrame, frame);
  };
  const toCamera = (step: number) => () => {
    const cameras = recording.get().cameras.map((camera) => camera.id);
    const at = cameras.indexOf(store.get().camera);
    const next = cameras[(at + step + cameras.length) % cameras.length];
    if (next !== undefined) act(selectCamera, next);
  };

  return {
    "frame.forward": toFrame((state) => state.frame + 10),
    "frame.back": toFrame((state) => state.frame - 10),
    "frame.nextAnnotated": toFrame((state) => annotatedFrames(state).find((frame) => frame > state.frame)),
    "frame.previousAnnotated": toFrame((state) => annotatedFrames(state).findLast((frame) => frame < state.frame)),
    "camera.next": toCamera(1),
    "camera.previous": toCamera(-1),
    "joint.next": () => act(stepJoint, 1),
    "joint.previous": () => act(stepJoint, -1),
    "joint.place": () => {
      const camera = recording.get().cameras.find((one) => one.id === store.get().camera);
      if (camera) act(placeBeside, { x: camera.width / 2, y: camera.height / 2 });
    },
    ...Object.fromEntries(FINGER_KEYS.map((finger, index) => [`finger.${finger}`, () => act(selectFinger, index - 1)])),
    ...Object.fromEntries(Object.entries(NUDGES).map(([id, by]) => [id, () => act(nudgeJoint, by)])),
    "joint.occluded": simple(toggleOccluded),
    "joint.outside": simple(toggleOutside),
    "hand.outside": simple(restOutside),
    "joint.clear": simple(clearJoint),
    "hand.clear": simple(clearHand),
    "hand.switch": simple(switchHand),
    "hand.bring": simple(bringPose),
    "hand.propagate": simple(propagateOn),
    "hand.swap": simple(swapHands),
    "key.mark": () => {
      const here = activeKey(store.get());
      if (!isEmpty(poseAt(store.get(), here))) session.keyFrames.toggle(keyText(here));
    },
    "key.accept": () => {
      const state = store.get();
      const span = spanAt(keyFramesOf(session.keyFrames.store.get(), state.poses, activeKey(state)), state.frame);
      if (span) act(acceptBetween, span);
    },
    undo: () => session.undo.undo(),
    redo: () => session.undo.redo(),
    "save.now": () => session.flush(),
  };
}
