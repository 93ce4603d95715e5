import { Button, Group, NumberInput, Stack, Text } from "@mantine/core";
import { IconCopyPlus } from "@tabler/icons-react";
import { useState } from "react";
import { openFramesAhead, propagateTo } from "../../actions/annotate/propagate";
import { formatCount } from "../../model/format";
import { isEmpty, keyText } from "../../model/pose";
import { activeKey, poseAt } from "../../state/annotator";
import { useHint } from "../../state/keys";
import { useAnnotating } from "./annotating";
import { useAnnotation } from "./reading";
import { ToolPopover } from "./ToolPopover";

function Propagate({ close }: { close: () => void }) {
  const { act, run } = useAnnotating();
  const state = useAnnotation((now) => now);
  const hint = useHint();
  const open = openFramesAhead(state);
  const end = open.at(-1) ?? state.frame;
  const [last, setLast] = useState(end);
  const wanted = openFramesAhead(state, last);
  const blocker = end + 1 < state.frameCount ? `frame ${end + 1} is annotated` : "the recording ends";
  return (
    <Stack gap="sm">
      <Text size="sm" fw={600}>
        Copy the {state.hand} hand to the next frames
      </Text>
      <Button
        size="xs"
        variant="default"
        onClick={() => {
          run("hand.propagate");
          close();
        }}
      >
        {hint("To the next frame", "hand.propagate")}
      </Button>
      {open.length > 0 ? (
        <>
          <Group gap="sm" wrap="nowrap" align="flex-end">
            <NumberInput size="xs" label="Up to frame" min={state.frame + 1} max={end} clampBehavior="strict" allowDecimal={false} value={last} onChange={(value) => typeof value === "number" && setLast(value)} />
            <Button
              size="xs"
              disabled={wanted.length === 0}
              onClick={() => {
                act(propagateTo, { key: keyText(activeKey(state)), last });
                close();
              }}
            >
              Copy to {formatCount(wanted.length, "frame")}
            </Button>
          </Group>
          <Text size="xs" className="quiet">
            At most to frame {end}, because {blocker}. One step for undo.
          </Text>
        </>
      ) : (
        <Text size="xs" className="quiet">
          The pose cannot be copied further: {blocker}.
        </Text>
      )}
    </Stack>
  );
}

/** The pose, carried over a range of frames. */
export function PropagateTool() {
  const isNothing = useAnnotation((state) => isEmpty(poseAt(state, activeKey(state))));
  return (
    <ToolPopover label="Copy the pose to the next frames" icon={<IconCopyPlus size={18} />} isDisabled={isNothing} width={248}>
      {(close) => <Propagate close={close} />}
    </ToolPopover>
  );
}
