import { Button, Text, Tooltip } from "@mantine/core";
import { IconFileAlert } from "@tabler/icons-react";
import type { ReactNode } from "react";
import type { StageParts } from "../../canvas/hand3d/useStage";
import { errorGradient, SCAN_ERROR_FULL_MM } from "../../model/errorColor";
import { useHint } from "../../state/keys";
import view from "../hand3d/HandView.module.css";
import classes from "./Moving.module.css";

interface MovingViewProps {
  label: string;
  parts: StageParts;
  isBusy: boolean;
  hasLegend: boolean;
  /** Hands that the frame does not show. */
  guessed: readonly string[];
  /** In the corner: which frame. */
  place: string;
  /** The frame's file cannot be used. */
  isUnusable: boolean;
  /** Why nothing can be drawn. */
  failure?: ReactNode;
}

/** A person in 3D: drag to turn, wheel to come nearer, right drag to move. */
export function MovingView({ label, parts: { holder, canvas, stage, failure: noStage }, isBusy, hasLegend, guessed, place, isUnusable, failure }: MovingViewProps) {
  const hint = useHint();
  return (
    <div ref={holder} className={view.pane} role="application" aria-label={label} tabIndex={0} data-picture aria-busy={isBusy}>
      <canvas ref={canvas} className={view.canvas} aria-hidden />
      <div className={classes.place}>{place}</div>
      {isUnusable && (
        <div className={classes.unusable} role="status">
          <IconFileAlert size={40} stroke={1.25} aria-hidden />
          The file of this frame cannot be used; the others can be.
        </div>
      )}
      {guessed.length > 0 && (
        <div className={classes.guessed} role="status">
          <span className={classes.mark} aria-hidden />
          {guessed.length === 2 ? "Both hands are guessed: the scan does not show them" : `The ${guessed[0]} hand is guessed: the scan does not show it`}
        </div>
      )}
      <div className={view.sides} role="group" aria-label="Look from">
        <Tooltip label={hint("The whole person, from the front", "moving.whole")}>
          <Button size="compact-xs" variant="default" onClick={() => stage?.reset()}>
            Front
          </Button>
        </Tooltip>
        <Tooltip label={hint("The whole person, from behind", "moving.behind")}>
          <Button size="compact-xs" variant="default" onClick={() => stage?.lookFrom("back")}>
            Behind
          </Button>
        </Tooltip>
      </div>
      {hasLegend && (
        <div className={view.legend}>
          <Text size="xs">0</Text>
          <span className={view.scale} style={{ background: errorGradient }} aria-hidden />
          <Text size="xs">{SCAN_ERROR_FULL_MM} mm and more between scan and body</Text>
        </div>
      )}
      {isBusy && !failure && !noStage && (
        <div className={view.waiting} role="status">
          <span>Loading the frame</span>
        </div>
      )}
      {(failure || noStage) && <div className={view.failure}>{noStage ? <Text role="alert">{noStage}</Text> : failure}</div>}
    </div>
  );
}
