import { Button, Group, Text } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";
import { useState } from "react";
import { Link } from "react-router";
import type { HandToLookAt, Recording } from "../../api/types";
import { describeShown, findMeant } from "../../model/lookAt";
import { HandBadge } from "../parts/HandBadge";
import { FlagPicture, type PictureState } from "./FlagPicture";
import classes from "./LabelCheck.module.css";

/** One hand that a person should look at, with the reasons. */
export function LookItem({ recording, item }: { recording: Recording; item: HandToLookAt }) {
  const [picture, setPicture] = useState<PictureState>("waiting");
  const at = new URLSearchParams({ camera: item.camera, frame: String(item.frame), hand: item.hand });
  const annotate = `/recordings/${recording.id}/annotate?${at}`;
  return (
    <li className={`card ${classes.item}`}>
      <Link to={annotate} className={classes.look} aria-label={`Look at frame ${item.frame}, ${item.hand} hand`}>
        <FlagPicture recording={recording} flag={{ ...item, joints: findMeant(item) }} onState={setPicture} />
      </Link>
      <div className={classes.text}>
        <Group justify="space-between" wrap="nowrap" gap={8}>
          <Group gap={8}>
            <HandBadge hand={item.hand} />
            <Text size="sm" fw={600}>
              frame {item.frame}
              {recording.cameras.length > 1 ? `, ${item.camera}` : ""}
            </Text>
          </Group>
          <Text size="xs" className="quiet" title="1 is where something begins to look wrong">
            {item.score.toFixed(1)}
          </Text>
        </Group>
        <ul className={classes.reasons} aria-label="Reasons">
          {item.doubts.map((doubt) => (
            <li key={`${doubt.kind}|${doubt.flag}|${doubt.reason}`}>{doubt.reason}</li>
          ))}
        </ul>
        <Text size="xs" className="quiet">
          {describeShown(item)}
        </Text>
        <Group gap={8} mt="auto">
          <Button size="compact-xs" variant="default" component={Link} to={annotate} leftSection={<IconPencil size={14} aria-hidden />}>
            {item.shows === "label" ? "Mend" : "Annotate"}
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
