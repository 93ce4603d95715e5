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
import { useMemo } from "react";
import { annotatedFrames } from "../../actions/annotate/bring";
import { keyFramesOf, spanAt } from "../../model/interpolation";
import { HANDS } from "../../model/joints";
import { isEmpty, keyText, placedCount } from "../../model/pose";
import { activeKey, activePose, poseAt } from "../../state/annotator";
import { arrangementsOf } from "../../state/viewOptions";
import { useAnnotating } from "./annotating";
import { BrightnessTool } from "./BrightnessTool";
import { DepthTool } from "./DepthTool";
import { TOOLS } from "./mounts";
import { PropagateTool } from "./PropagateTool";
import { useAnnotation, useCamera, useKeyFrames, useOption, usePage } from "./reading";
import { Tool } from "../parts/Tool";
import { useHasFingers, useIsCompact } from "../parts/useScreen";
import classes from "./ToolRail.module.css";

/** The things one does, as buttons; each says its key. */
export function ToolRail() {
  const { session, setOptions, run } = useAnnotating();
  const camera = useCamera();
  // Frames that are another's, in review or accepted: what would change a label is not offered.
  const isLocked = usePage((page) => page.lock !== null);
  const isCompact = useIsCompact();
  const hasFingers = useHasFingers();
  // What was done changes with the labels.
  const canUndo = useAnnotation(() => session.undo.canUndo());
  const canRedo = useAnnotation(() => session.undo.canRedo());
  const poses = useAnnotation((state) => state.poses);
  const hand = useAnnotation((state) => state.hand);
  const first = useMemo(() => annotatedFrames({ poses, camera: camera.id }, hand)[0] ?? Infinity, [poses, camera.id, hand]);
  const canBring = useAnnotation((state) => first < state.frame);
  const keys = useKeyFrames((now) => now);
  const isKey = useAnnotation((state) => keys.has(keyText(activeKey(state))));
  const isBetween = useAnnotation((state) => spanAt(keyFramesOf(keys, state.poses, activeKey(state)), state.frame) !== null);
  const hasHands = useAnnotation((state) => HANDS.some((one) => !isEmpty(poseAt(state, { ...activeKey(state), hand: one }))));
  const hasPose = useAnnotation((state) => placedCount(activePose(state)) > 0);
  const [isTouchMarking, areHandsShown, areNamesShown] = [useOption("isTouchMarking"), useOption("areHandsShown"), useOption("areNamesShown")];
  const hasSeveralPictures = arrangementsOf(camera).length > 1;
  const size = 18;
  return (
    <div className={classes.rail} role="toolbar" aria-label="Tools" aria-orientation={isCompact ? "horizontal" : "vertical"}>
      {hasFingers && (
        <Tool
          label={isTouchMarking ? "Only look by touch" : "Mark joints by touch"}
          action="touch.mark"
          icon={<IconHandFinger size={size} />}
          isOn={isTouchMarking}
          onClick={() => setOptions({ isTouchMarking: !isTouchMarking })}
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
      <Tool label="Accept what is between the key frames" action="key.accept" icon={<IconTimelineEvent size={size} />} isDisabled={isLocked || !isBetween} onClick={() => run("key.accept")} />
      <Divider w={24} />
      <Tool label="Fit the image" action="view.fit" icon={<IconArrowsMaximize size={size} />} onClick={() => run("view.fit")} />
      {hasSeveralPictures && <Tool label="Arrange colour and depth" action="view.depth" icon={<IconPictureInPicture size={size} />} onClick={() => run("view.depth")} />}
      <BrightnessTool />
      {camera.has_depth && <DepthTool />}
      <Tool
        label={areHandsShown ? "Hide the hands" : "Show the hands"}
        action="view.hands"
        icon={areHandsShown ? <IconHandStop size={size} /> : <IconHandOff size={size} />}
        isOn={!areHandsShown}
        onClick={() => run("view.hands")}
      />
      <Tool label="Joint names" action="view.names" icon={areNamesShown ? <IconEye size={size} /> : <IconLabel size={size} />} isOn={areNamesShown} onClick={() => run("view.names")} />
      {TOOLS.map((Extra, index) => (
        <Extra key={index} />
      ))}
    </div>
  );
}
