import { ActionIcon, Button, Menu, Select, Text, Tooltip } from "@mantine/core";
import { IconChevronLeft, IconChevronRight, IconDots, IconPlayerPause, IconPlayerPlay, IconPlayerTrackNext, IconTrash } from "@tabler/icons-react";
import { Link, useNavigate } from "react-router";
import { useDeleteMovingScan, useRestoreMovingScan, type MovingRegistration, type MovingScan } from "../../api/movingScans";
import { formatCount } from "../../model/format";
import { useHint } from "../../state/keys";
import { For } from "../parts/For";
import { intoBin } from "../parts/undo";
import classes from "./Moving.module.css";
import { PRIORS } from "./priors";

interface MovingBarProps {
  scan: MovingScan;
  registrations: readonly MovingRegistration[];
  registration: MovingRegistration | undefined;
  onRegistration: (id: string) => void;
  frame: number;
  isPlaying: boolean;
  hasDoubts: boolean;
  onPlay: () => void;
  onStep: (by: number) => void;
  onDoubt: () => void;
  onRegister: () => void;
}

const nameOf = ({ number, prior, first_frame, last_frame, parent_id }: MovingRegistration): string =>
  `${number}: ${PRIORS[prior].label}${parent_id ? `, frames ${first_frame} to ${last_frame}` : ""}`;

/** Which moving scan and registration, which frame, and how it is played. */
export function MovingBar({ scan, registrations, registration, onRegistration, frame, isPlaying, hasDoubts, onPlay, onStep, onDoubt, onRegister }: MovingBarProps) {
  const hint = useHint();
  const remove = useDeleteMovingScan();
  const restore = useRestoreMovingScan();
  const navigate = useNavigate();
  const drop = (): void =>
    remove.mutate(
      scan.id,
      intoBin(scan.name, () => restore.mutateAsync(scan.id), () => void navigate("/scans/moving")),
    );
  return (
    <div className={classes.bar}>
      <Text className={`one-line ${classes.name}`} fw={600} title={scan.name}>
        {scan.name}
      </Text>
      <Text size="sm" className="quiet one-line">
        {[scan.subject, formatCount(scan.frame_count, "frame"), `${scan.fps.toLocaleString("en")} a second`].filter(Boolean).join(" · ")}
      </Text>
      {registrations.length > 0 && (
        <Select
          size="xs"
          w={248}
          aria-label="Registration"
          allowDeselect={false}
          data={registrations.map((one) => ({ value: one.id, label: nameOf(one) }))}
          value={registration?.id ?? null}
          onChange={(id) => id && onRegistration(id)}
        />
      )}
      <For role="reviewer">
        <Button size="compact-sm" variant={registrations.length > 0 ? "default" : "filled"} onClick={onRegister}>
          Register …
        </Button>
      </For>
      <div className={classes.controls}>
        <Tooltip label={hint(isPlaying ? "Pause" : "Play", "moving.play")}>
          <ActionIcon aria-label={isPlaying ? "Pause" : "Play"} disabled={scan.frame_count < 2} onClick={onPlay}>
            {isPlaying ? <IconPlayerPause size={18} /> : <IconPlayerPlay size={18} />}
          </ActionIcon>
        </Tooltip>
        <Tooltip label={hint("Previous frame", "moving.previous")}>
          <ActionIcon aria-label="Previous frame" onClick={() => onStep(-1)}>
            <IconChevronLeft size={18} />
          </ActionIcon>
        </Tooltip>
        <span className={classes.frame} data-testid="moving-frame">
          frame {frame} of {scan.frame_count}
        </span>
        <Tooltip label={hint("Next frame", "moving.next")}>
          <ActionIcon aria-label="Next frame" onClick={() => onStep(1)}>
            <IconChevronRight size={18} />
          </ActionIcon>
        </Tooltip>
        <Tooltip label={hint("Next frame that is not good or has a guessed hand", "moving.nextDoubt")}>
          <ActionIcon aria-label="Next frame that is not good or has a guessed hand" disabled={!hasDoubts} onClick={onDoubt}>
            <IconPlayerTrackNext size={18} />
          </ActionIcon>
        </Tooltip>
        <Menu position="bottom-end">
          <Menu.Target>
            <ActionIcon aria-label="More">
              <IconDots size={18} />
            </ActionIcon>
          </Menu.Target>
          <Menu.Dropdown>
            <Menu.Item component={Link} to="/scans/moving">
              To all moving scans
            </Menu.Item>
            {registration && (
              <Menu.Item component={Link} to={`/jobs/${registration.job_id}`}>
                To the job of this registration
              </Menu.Item>
            )}
            <For role="lead">
              <Menu.Item color="red" onClick={drop} leftSection={<IconTrash size={16} aria-hidden />}>
                Delete (can be undone)
              </Menu.Item>
            </For>
          </Menu.Dropdown>
        </Menu>
      </div>
    </div>
  );
}
