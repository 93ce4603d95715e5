import { Button, Group, SegmentedControl, Stack, Text } from "@mantine/core";
import { useState } from "react";
import { jointLabel } from "../../model/joints";
import { emptyPose, fromWire, parseKey, statusOf, type Pose } from "../../model/pose";
import type { Theirs } from "../../state/saveQueue";
import classes from "./ConflictCard.module.css";

interface ConflictCardProps {
  poseKey: string;
  mine: Pose | undefined;
  theirs: Theirs;
  isHere: boolean;
  onGo: () => void;
  onSettle: (choice: "mine" | "theirs" | Pose) => void;
}

type Pick = "mine" | "theirs";

function differing(mine: Pose, theirs: Pose): number[] {
  return mine.flatMap((point, joint) => {
    const other = theirs[joint];
    const isSame = other && statusOf(point) === statusOf(other) && Math.hypot(point.x - other.x, point.y - other.y) < 0.05;
    return isSame ? [] : [joint];
  });
}

/** Somebody else was faster: choose, without being stopped in one's work. Their version is drawn violet and dashed. */
export function ConflictCard({ poseKey, mine, theirs, isHere, onGo, onSettle }: ConflictCardProps) {
  const [isByJoint, setByJoint] = useState(false);
  const [picks, setPicks] = useState<Record<number, Pick>>({});
  const { frame, hand, camera } = parseKey(poseKey);
  const minePose = mine ?? emptyPose();
  const theirPose = theirs.points ? fromWire(theirs.points) : emptyPose();
  const joints = differing(minePose, theirPose);
  const merge = (): Pose => minePose.map((point, joint) => (picks[joint] === "theirs" ? (theirPose[joint] ?? point) : point));

  return (
    <section className={classes.card} data-over-picture aria-label="Two versions" role="group">
      <Text fw={600} size="sm">
        {theirs.points && theirs.author ? `${theirs.author} changed` : theirs.points ? "Somebody changed" : "Somebody deleted"} the {hand} hand of frame {frame}
      </Text>
      <Text size="xs" className="quiet">
        Camera {camera}; {joints.length} {joints.length === 1 ? "joint differs" : "joints differ"}. Both versions are safe until you choose.
      </Text>
      {isByJoint && (
        <Stack gap={2} className={classes.joints}>
          {joints.map((joint) => (
            <Group key={joint} justify="space-between" wrap="nowrap">
              <Text size="xs">{jointLabel(joint)}</Text>
              <SegmentedControl
                size="xs"
                aria-label={jointLabel(joint)}
                data={["mine", "theirs"]}
                value={picks[joint] ?? "mine"}
                onChange={(pick) => setPicks((now) => ({ ...now, [joint]: pick }))}
              />
            </Group>
          ))}
        </Stack>
      )}
      <Group gap="sm">
        {isByJoint ? (
          <>
            <Button size="xs" onClick={() => onSettle(merge())}>
              Keep this choice
            </Button>
            <Button size="xs" variant="subtle" onClick={() => setByJoint(false)}>
              Back
            </Button>
          </>
        ) : (
          <>
            <Button size="xs" onClick={() => onSettle("mine")}>
              Keep mine
            </Button>
            <Button size="xs" variant="default" onClick={() => onSettle("theirs")}>
              Take theirs
            </Button>
            {theirs.points && (
              <Button size="xs" variant="default" onClick={() => setByJoint(true)}>
                By joint …
              </Button>
            )}
            {!isHere && (
              <Button size="xs" variant="subtle" onClick={onGo}>
                Show
              </Button>
            )}
          </>
        )}
      </Group>
    </section>
  );
}
