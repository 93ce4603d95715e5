import { Button, Group, Text } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import type { Flag, Recording } from "../../api/types";
import { KIND_NAMES } from "../../model/flag";
import { HandBadge } from "../parts/HandBadge";
import { FlagPicture, type PictureState } from "./FlagPicture";
import classes from "./LabelCheck.module.css";

interface FlagItemProps {
  recording: Recording;
  flag: Flag;
  isDismissed: boolean;
  isBusy: boolean;
  /** Find it right, or bring it back. */
  onJudge: () => void;
}

/** One label that looks wrong; it is judged only once its picture is there. */
export function FlagItem({ recording, flag, isDismissed, isBusy, onJudge }: FlagItemProps) {
  const [picture, setPicture] = useState<PictureState>("waiting");
  const at = new URLSearchParams({ camera: flag.camera, frame: String(flag.frame), hand: flag.hand });
  const annotate = `/recordings/${recording.id}/annotate?${at}`;
  return (
    <li className={`card ${classes.item}`}>
      <Link to={annotate} className={classes.look} aria-label={`Annotate frame ${flag.frame}, ${flag.hand} hand`}>
        <FlagPicture recording={recording} flag={flag} onState={setPicture} />
      </Link>
      <div className={classes.text}>
        <Group justify="space-between" wrap="nowrap" gap={8}>
          <Text size="sm" fw={600}>
            {KIND_NAMES[flag.kind]}
          </Text>
          <Text size="xs" className="quiet" title="1 is where a label begins to look wrong">
            {flag.score.toFixed(1)}
          </Text>
        </Group>
        <Group gap={8}>
          <HandBadge hand={flag.hand} />
          <Text size="xs" className="quiet">
            frame {flag.frame}
            {recording.cameras.length > 1 ? `, ${flag.camera}` : ""}
          </Text>
        </Group>
        <Text size="xs" className={classes.reason}>
          {flag.reason}
        </Text>
        <Group gap={8} mt="auto">
          <Button size="compact-xs" variant="default" component={Link} to={annotate} leftSection={<IconPencil size={14} aria-hidden />}>
            Mend
          </Button>
          <Button size="compact-xs" variant="subtle" disabled={isBusy || picture !== "here"} onClick={onJudge}>
            {isDismissed ? "Restore" : "It is right"}
          </Button>
          {picture === "missing" && (
            <Text size="xs" c="var(--bad-text)" role="alert">
              The picture could not be loaded.
            </Text>
          )}
        </Group>
      </div>
    </li>
  );
}
