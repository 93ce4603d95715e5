import { ActionIcon, Divider, Popover, Slider, Stack, Text, Tooltip } from "@mantine/core";
import {
  IconArrowBackUp,
  IconArrowForwardUp,
  IconArrowsMaximize,
  IconCopy,
  IconEye,
  IconEyeOff,
  IconHandOff,
  IconHandStop,
  IconLabel,
  IconPictureInPicture,
  IconSquareOff,
  IconSun,
  IconTrash,
  IconX,
} from "@tabler/icons-react";
import { annotatedFrames } from "../../actions/annotate/bring";
import { placedCount } from "../../model/pose";
import { arrangementsOf, clampFactor } from "../../state/viewOptions";
import { useAnnotating } from "./annotating";
import { TOOLS } from "./mounts";
import { Tool } from "./Tool";
import classes from "./ToolRail.module.css";

/** The things one does, as buttons; each says its key. */
export function ToolRail() {
  const { state, session, camera, pose, options, setOptions: onOptions, run } = useAnnotating();
  const [canUndo, canRedo] = [session.undo.canUndo(), session.undo.canRedo()];
  const canBring = annotatedFrames(state, state.hand).some((frame) => frame < state.frame);
  const hasPose = placedCount(pose) > 0;
  const hasSeveralPictures = arrangementsOf(camera).length > 1;
  const size = 18;
  const isAdjusted = options.brightness !== 1 || options.contrast !== 1;
  return (
    <div className={classes.rail} role="toolbar" aria-label="Tools" aria-orientation="vertical">
      <Tool label="Undo" action="undo" icon={<IconArrowBackUp size={size} />} isDisabled={!canUndo} onClick={() => run("undo")} />
      <Tool label="Redo" action="redo" icon={<IconArrowForwardUp size={size} />} isDisabled={!canRedo} onClick={() => run("redo")} />
      <Divider w={24} />
      <Tool label="Occluded, or visible again" action="joint.occluded" icon={<IconEyeOff size={size} />} isDisabled={!hasPose} onClick={() => run("joint.occluded")} />
      <Tool label="Outside the image" action="joint.outside" icon={<IconSquareOff size={size} />} onClick={() => run("joint.outside")} />
      <Tool label="Clear the joint" action="joint.clear" icon={<IconX size={size} />} isDisabled={!hasPose} onClick={() => run("joint.clear")} />
      <Tool label="Clear the whole hand" action="hand.clear" icon={<IconTrash size={size} />} isDisabled={!hasPose} onClick={() => run("hand.clear")} />
      <Tool label="Bring the last annotated pose" action="hand.bring" icon={<IconCopy size={size} />} isDisabled={!canBring} onClick={() => run("hand.bring")} />
      <Divider w={24} />
      <Tool label="Fit the image" action="view.fit" icon={<IconArrowsMaximize size={size} />} onClick={() => run("view.fit")} />
      {hasSeveralPictures && <Tool label="Arrange colour and depth" action="view.depth" icon={<IconPictureInPicture size={size} />} onClick={() => run("view.depth")} />}
      <Popover position="right-start" withArrow shadow="md" trapFocus returnFocus>
        <Popover.Target>
          <Tooltip label="Brightness and contrast" position="right">
            <ActionIcon size={32} aria-label="Brightness and contrast" variant={isAdjusted ? "light" : "subtle"} color={isAdjusted ? "teal" : "gray"}>
              <IconSun size={size} />
            </ActionIcon>
          </Tooltip>
        </Popover.Target>
        <Popover.Dropdown>
          <Stack gap="sm" w={240}>
            <Text size="xs">Brightness {options.brightness.toFixed(2)}</Text>
            <Slider aria-label="Brightness" min={0.25} max={4} step={0.05} value={options.brightness} onChange={(value) => onOptions({ brightness: clampFactor(value) })} label={null} />
            <Text size="xs">Contrast {options.contrast.toFixed(2)}</Text>
            <Slider aria-label="Contrast" min={0.25} max={4} step={0.05} value={options.contrast} onChange={(value) => onOptions({ contrast: clampFactor(value) })} label={null} />
            <Text
              size="xs"
              component="button"
              type="button"
              className={classes.reset}
              onClick={() => onOptions({ brightness: 1, contrast: 1 })}
            >
              As recorded
            </Text>
          </Stack>
        </Popover.Dropdown>
      </Popover>
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
