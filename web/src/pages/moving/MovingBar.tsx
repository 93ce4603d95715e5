import { Button, Menu, Select, Text } from "@mantine/core";
import { IconPlayerTrackNext } from "@tabler/icons-react";
import { Link, useNavigate } from "react-router";
import { useDeleteMovingScan, useRestoreMovingScan, type MovingRegistration, type MovingScan } from "../../api/movingScans";
import { formatCount } from "../../model/format";
import { For } from "../parts/For";
import { FrameSteps } from "../parts/FrameSteps";
import { KeyIcon } from "../parts/KeyIcon";
import { MoreMenu } from "../parts/MoreMenu";
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

const STEPS = { play: "moving.play", previous: "moving.previous", next: "moving.next" };

/** Which moving scan and registration, which frame, and how it is played. */
export function MovingBar({ scan, registrations, registration, onRegistration, frame, isPlaying, hasDoubts, onPlay, onStep, onDoubt, onRegister }: MovingBarProps) {
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
        <FrameSteps isPlaying={isPlaying} canPlay={scan.frame_count > 1} actions={STEPS} onPlay={onPlay} onStep={onStep}>
          <span className={classes.frame} data-testid="moving-frame">
            frame {frame} of {scan.frame_count}
          </span>
        </FrameSteps>
        <KeyIcon label="Next frame that is not good or has a guessed hand" action="moving.nextDoubt" disabled={!hasDoubts} onClick={onDoubt}>
          <IconPlayerTrackNext size={18} />
        </KeyIcon>
        <MoreMenu onDelete={drop}>
          <Menu.Item component={Link} to="/scans/moving">
            To all moving scans
          </Menu.Item>
          {registration && (
            <Menu.Item component={Link} to={`/jobs/${registration.job_id}`}>
              To the job of this registration
            </Menu.Item>
          )}
        </MoreMenu>
      </div>
    </div>
  );
}
