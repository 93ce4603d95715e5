import { ActionIcon, Group, Slider, Text, Tooltip } from "@mantine/core";
import { IconPlayerPause, IconPlayerPlay, IconX } from "@tabler/icons-react";
import { formatCount } from "../../model/format";
import classes from "./BodyPage.module.css";
import type { MotionState, OpenMotion } from "./useMotion";

interface MotionBarProps {
  open: OpenMotion;
  state: MotionState;
  onClose: () => void;
}

/** Play a motion, or go to one of its frames. */
export function MotionBar({ open, state, onClose }: MotionBarProps) {
  const { motion, name } = open;
  const count = motion.poses.length;
  const label = state.isPlaying ? "Pause" : "Play";
  return (
    <Group className={classes.motion} gap="sm" wrap="nowrap" role="group" aria-label="Motion">
      <Tooltip label={label}>
        <ActionIcon aria-label={label} disabled={count < 2} onClick={() => state.play(!state.isPlaying)}>
          {state.isPlaying ? <IconPlayerPause size={18} /> : <IconPlayerPlay size={18} />}
        </ActionIcon>
      </Tooltip>
      <Slider flex={1} size="sm" min={0} max={Math.max(1, count - 1)} disabled={count < 2} label={null} thumbLabel="Frame" value={state.frame} onChange={state.goTo} />
      <Text size="sm" className={classes.frame} data-testid="body-frame">
        frame {state.frame} of {count}
      </Text>
      <Text size="xs" className="quiet one-line" maw={280} title={name}>
        {name}, {formatCount(Math.round(motion.fps), "frame")} a second
      </Text>
      <Tooltip label="Close the motion">
        <ActionIcon aria-label="Close the motion" onClick={onClose}>
          <IconX size={18} />
        </ActionIcon>
      </Tooltip>
    </Group>
  );
}
