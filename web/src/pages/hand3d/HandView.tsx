import { Button, Text, Tooltip } from "@mantine/core";
import type { ReactNode } from "react";
import { errorGradient, SCAN_ERROR_FULL_MM } from "../../model/errorColor";
import type { ViewSide } from "../../canvas/hand3d/look";
import type { StageParts } from "../../canvas/hand3d/useStage";
import { useHint } from "../../state/keys";
import classes from "./HandView.module.css";

interface HandViewProps {
  scope: "curate" | "scan";
  label: string;
  parts: StageParts;
  /** Something is on its way. */
  isBusy: boolean;
  hasLegend: boolean;
  /** Why nothing can be drawn, with the next step. */
  failure?: ReactNode;
  children?: ReactNode;
}

const SIDES: readonly (readonly [ViewSide, string])[] = [
  ["palm", "Palm"],
  ["back", "Back"],
  ["thumb", "Thumb"],
  ["little", "Little finger"],
];

/** A hand in 3D: drag to turn, wheel to come nearer, right drag to move; everything else by buttons and keys. */
export function HandView({ scope, label, parts: { holder, canvas, stage, failure: noStage }, isBusy, hasLegend, failure, children }: HandViewProps) {
  const hint = useHint();
  const from = (side: ViewSide): void => (side === "palm" ? stage?.reset() : stage?.lookFrom(side));
  return (
    <div ref={holder} className={classes.pane} role="application" aria-label={label} tabIndex={0} data-picture data-hand-view aria-busy={isBusy}>
      <canvas ref={canvas} className={classes.canvas} aria-hidden />
      {children}
      <div className={classes.sides} role="group" aria-label="Look from">
        {SIDES.map(([side, name]) => (
          <Tooltip key={side} label={hint(`From the ${name.toLowerCase()}’s side`, `${scope}.${side}`)}>
            <Button size="compact-xs" variant="default" onClick={() => from(side)}>
              {name}
            </Button>
          </Tooltip>
        ))}
      </div>
      {hasLegend && (
        <div className={classes.legend}>
          <Text size="xs">0</Text>
          <span className={classes.scale} style={{ background: errorGradient }} aria-hidden />
          <Text size="xs">{SCAN_ERROR_FULL_MM} mm and more between scan and mesh</Text>
        </div>
      )}
      {isBusy && !failure && !noStage && <div className={classes.waiting} role="status">
          <span>Loading the hand</span>
        </div>}
      {(failure || noStage) && <div className={classes.failure}>{noStage ? <Text role="alert">{noStage}</Text> : failure}</div>}
    </div>
  );
}
