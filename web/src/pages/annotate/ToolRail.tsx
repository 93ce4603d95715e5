import { Divider } from "@mantine/core";
import {
  IconArrowBackUp,
  IconArrowForwardUp,
  IconArrowsLeftRight,
  IconArrowsMaximize,
  IconCopy,
  IconDiamond,
  IconDiamondFilled,
  IconEye,
  IconEyeOff,
  IconHandFinger,
  IconHandOff,
  IconHandStop,
  IconLabel,
  IconPictureInPicture,
  IconSquareOff,
  IconTimelineEvent,
  IconTrash,
  IconX,
} from "@tabler/icons-react";
import { annotatedFrames } from "../../actions/annotate/bring";
import { keyFramesOf, spanAt } from "../../model/interpolation";
import { HANDS } from "../../model/joints";
import { isEmpty, keyText, placedCount } from "../../model/pose";
import { activeKey, poseAt } from "../../state/annotator";
import { arrangementsOf } from "../../state/viewOptions";
import { useAnnotating } from "./annotating";
import { BrightnessTool } from "./BrightnessTool";
import { DepthTool } from "./DepthTool";
import { TOOLS } from "./mounts";
import { PropagateTool } from "./PropagateTool";
import { Tool } from "../parts/Tool";
import { useHasFingers, useIsCompact } from "../parts/useScreen";
import classes from "./ToolRail.module.css";
import { useKeyFrames } from "./useSession";

/** The things one does, as buttons; each says its key. */
export function ToolRail() {
  const { state, session, camera, pose, options, setOptions, run, lock } = useAnnotating();
  // Frames that are another's, in review or accepted: what would change a label is not offered.
  const isLocked = lock !== null;
  const isCompact = useIsCompact();
  const hasFingers = useHasFingers();
  const [canUndo, canRedo] = [session.undo.canUndo(), session.undo.canRedo()];
  const canBring = annotatedFrames(state, state.hand).some((frame) => frame < state.frame);
  const keys = useKeyFrames(session);
  const isKey = keys.has(keyText(activeKey(state)));
  const span = spanAt(keyFramesOf(keys, state.poses, activeKey(state)), state.frame);
  const hasHands = HANDS.some((hand) => !isEmpty(poseAt(state, { ...activeKey(state), hand })));
  const hasPose = placedCount(pose) > 0;
  const hasSeveralPictures = arrangementsOf(camera).length > 1;
  const size = 18;
  return (
    <div className={classes.rail} role="toolbar" aria-label="Tools" aria-orientation={isCompact ? "horizontal" : "vertical"}>
      {hasFingers && (
        <Tool
          label={options.isTouchMarking ? "Only look by touch" : "Mark joints by touch"}
          action="touch.mark"
          icon={<IconHandFinger size={size} />}
          isOn={options.isTouchMarking}
          onClick={() => setOptions({ isTouchMarking: !options.isTouchMarking })}
        />
      )}
      <Tool label="Undo" action="undo" icon={<IconArrowBackUp size={size} />} isDisabled={!canUndo} onClick={() => run("undo")} />
      <Tool label="Redo" action="redo" icon={<IconArrowForwardUp size={size} />} isDisabled={!canRedo} onClick={() => run("redo")} />
      <Divider w={24} />
      <Tool label="Occluded, or visible again" action="joint.occluded" icon={<IconEyeOff size={size} />} isDisabled={isLocked || !hasPose} onClick={() => run("joint.occluded")} />
      <Tool label="Outside the image" action="joint.outside" icon={<IconSquareOff size={size} />} isDisabled={isLocked} onClick={() => run("joint.outside")} />
      <Tool label="Clear the joint" action="joint.clear" icon={<IconX size={size} />} isDisabled={isLocked || !hasPose} onClick={() => run("joint.clear")} />
      <Tool label="Clear the whole hand" action="hand.clear" icon={<IconTrash size={size} />} isDisabled={isLocked || !hasPose} onClick={() => run("hand.clear")} />
      <Tool label="Bring the last annotated pose" action="hand.bring" icon={<IconCopy size={size} />} isDisabled={isLocked || !canBring} onClick={() => run("hand.bring")} />
      <PropagateTool />
      <Tool label="Swap left and right" action="hand.swap" icon={<IconArrowsLeftRight size={size} />} isDisabled={isLocked || !hasHands} onClick={() => run("hand.swap")} />
      <Divider w={24} />
      <Tool label={isKey ? "No key frame any more" : "Key frame"} action="key.mark" icon={isKey ? <IconDiamondFilled size={size} /> : <IconDiamond size={size} />} isOn={isKey} isDisabled={isLocked || !hasPose} onClick={() => run("key.mark")} />
      <Tool label="Accept what is between the key frames" action="key.accept" icon={<IconTimelineEvent size={size} />} isDisabled={isLocked || !span} onClick={() => run("key.accept")} />
      <Divider w={24} />
      <Tool label="Fit the image" action="view.fit" icon={<IconArrowsMaximize size={size} />} onClick={() => run("view.fit")} />
      {hasSeveralPictures && <Tool label="Arrange colour and depth" action="view.depth" icon={<IconPictureInPicture size={size} />} onClick={() => run("view.depth")} />}
      <BrightnessTool />
      {camera.has_depth && <DepthTool />}
      <Tool
        label={options.areHandsShown ? "Hide the hands" : "Show the hands"}
        action="view.hands"
        icon={options.areHandsShown ? <IconHandStop size={size} /> : <IconHandOff size={size} />}
        isOn={!options.areHandsShown}
        onClick={() => run("view.hands")}
      />
      <Tool label="Joint names" action="view.names" icon={options.areNamesShown ? <IconEye size={size} /> : <IconLabel size={size} />} isOn={options.areNamesShown} onClick={() => run("view.names")} />
      {TOOLS.map((Extra, index) => (
        <Extra key={index} />
      ))}
    </div>
  );
}
