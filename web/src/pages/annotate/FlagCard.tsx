import { ActionIcon, Button, Group, Text, UnstyledButton } from "@mantine/core";
import { IconChevronDown, IconChevronUp, IconFlag } from "@tabler/icons-react";
import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo, useState } from "react";
import { goToFrame, selectCamera, selectJoint, switchHand } from "../../actions/annotate/select";
import { flagKeys, useDismissal, useFlags } from "../../api/flags";
import type { Flag } from "../../api/types";
import { KIND_NAMES, nextFlag } from "../../model/flag";
import type { FrameMarks } from "../../model/frameMarks";
import { keyText } from "../../model/pose";
import { activeKey } from "../../state/annotator";
import { useKeyOf } from "../../state/keys";
import { useIsCompact } from "../parts/useScreen";
import { useActions, useAnnotating } from "./annotating";
import { useAnnotation, useIsBlind, useSaving } from "./reading";
import classes from "./Annotator.module.css";

/** Labels are checked anew this long after they were saved. */
const CHECK_AFTER_MS = 1500;

/** Why the label in view looks wrong, and the keys that walk from one such label to the next. */
export function FlagCard() {
  const { recording: opened, session, act, run } = useAnnotating();
  const recording = opened.get();
  const key = useAnnotation((state) => keyText(activeKey(state)));
  const poses = useAnnotation((state) => state.poses);
  const client = useQueryClient();
  const isBlind = useIsBlind();
  const found = useFlags(recording.id).data?.items;
  const flags = isBlind || !found ? [] : found;
  const dismissal = useDismissal(recording.id);
  const keyOf = useKeyOf();
  // On a phone the picture has no room for a card: one line stands below it, and opens.
  const isCompact = useIsCompact();
  const [isOpen, setOpen] = useState(false);
  const isSaved = useSaving((saving) => saving.waiting === 0 && !saving.isSending);
  const savedAt = useSaving((saving) => saving.lastSavedAt);

  // A save may come and go between two drawings: `isSaved` alone would not tell. What others save changes the poses.
  useEffect(() => {
    if (!isSaved) return;
    const timer = setTimeout(() => void client.invalidateQueries({ queryKey: flagKeys.of(recording.id) }), CHECK_AFTER_MS);
    return () => clearTimeout(timer);
  }, [client, isSaved, savedAt, poses, recording.id]);

  const here = flags.filter((flag) => keyText(flag) === key);
  const first = here[0];
  const walk = (direction: 1 | -1) => (): void => {
    const now = session.store.get();
    const next = nextFlag(flags, now, direction);
    if (!next) return;
    act(selectCamera, next.camera);
    act(goToFrame, next.frame);
    if (next.hand !== now.hand) act(switchHand, undefined);
    if (next.joints[0] !== undefined) act(selectJoint, next.joints[0]);
  };
  const putAway = (flag: Flag | undefined): void => {
    if (flag) dismissal.mutate({ flag, isRight: true });
  };
  useActions({ "flag.next": walk(1), "flag.previous": walk(-1), "flag.dismiss": () => putAway(first) });

  if (isCompact && !isOpen && first) {
    return (
      <UnstyledButton className={`card ${classes.notice} ${classes.fold}`} aria-expanded={false} onClick={() => setOpen(true)}>
        <IconFlag size={16} color="var(--warn-text)" aria-hidden />
        <span className="one-line">Label check: {here.map((flag) => KIND_NAMES[flag.kind]).join(", ")}</span>
        <IconChevronDown size={16} aria-hidden />
      </UnstyledButton>
    );
  }
  return here.map((flag) => (
    <div key={flag.kind} className={`card ${classes.notice}`} role="group" aria-label={`Label check: ${KIND_NAMES[flag.kind]}`}>
      <Group gap={8} wrap="nowrap" mb={4}>
        <IconFlag size={16} color="var(--warn-text)" aria-hidden />
        <Text size="sm" fw={600}>
          {KIND_NAMES[flag.kind]}
        </Text>
        {isCompact && flag === first && (
          <ActionIcon ml="auto" aria-label="Fold the label check" aria-expanded onClick={() => setOpen(false)}>
            <IconChevronUp size={16} />
          </ActionIcon>
        )}
      </Group>
      <Text size="xs" mb={8}>
        {flag.reason}
      </Text>
      <Group gap={8}>
        <Button size="compact-xs" variant="default" onClick={() => (flag === first ? run("flag.dismiss") : putAway(flag))} disabled={dismissal.isPending || !isSaved}>
          It is right{flag === first && keyOf("flag.dismiss") ? ` (${keyOf("flag.dismiss")})` : ""}
        </Button>
        <Button size="compact-xs" variant="subtle" onClick={walk(1)}>
          Next ({keyOf("flag.next")})
        </Button>
      </Group>
      {dismissal.error && (
        <Text size="xs" mt={4} c="var(--bad-text)" role="alert">
          {dismissal.error.message}
        </Text>
      )}
    </div>
  ));
}

/** Flagged frames of this camera, for the timeline. */
export function useFlagMarks(): FrameMarks {
  const flags = useFlags(useAnnotating().recording.get().id).data?.items;
  const camera = useAnnotation((state) => state.camera);
  const isBlind = useIsBlind();
  return useMemo(() => ({ flagged: new Set((isBlind ? [] : (flags ?? [])).filter((flag) => flag.camera === camera).map((flag) => flag.frame)) }), [flags, isBlind, camera]);
}
