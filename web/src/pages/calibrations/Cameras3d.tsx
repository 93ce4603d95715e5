import { Button, Text } from "@mantine/core";
import { useEffect } from "react";
import type { CalibrationResult, PlacedBoard } from "../../api/calibrations";
import { BOARD_COLORS } from "../../canvas/cameras3d/stage";
import { useCamerasStage } from "../../canvas/cameras3d/useCamerasStage";
import { trackStyle } from "../../model/trackStyle";
import classes from "./calibrations.module.css";

interface Cameras3dProps {
  result: CalibrationResult;
  boards: readonly PlacedBoard[];
  /** Width and height, m. */
  boardSize: readonly [number, number];
}

const SIDES = [
  ["behind", "Behind"],
  ["above", "Above"],
  ["side", "Side"],
] as const;

/** Where the cameras stand and where they saw the board: drag to turn, wheel to come nearer. */
export function Cameras3d({ result, boards, boardSize }: Cameras3dProps) {
  const { holder, canvas, stage, failure } = useCamerasStage();
  const [width, height] = boardSize;
  useEffect(() => {
    stage?.show({
      cameras: result.cameras.map((camera, place) => ({ ...camera, color: trackStyle(place).color })),
      boards: boards.flatMap(({ T_world_board: T, left_out: isLeftOut }) => (T ? [{ T_world_board: T, isLeftOut }] : [])),
      boardSize: [width, height],
    });
  }, [stage, result, boards, width, height]);
  return (
    <div ref={holder} className={classes.stage} role="group" aria-label={`${result.cameras.length} cameras and ${boards.length} places of the board in space`} data-ready={stage !== null}>
      <canvas ref={canvas} aria-hidden />
      <div className={classes.sides} role="group" aria-label="Look from">
        {SIDES.map(([side, name]) => (
          <Button key={side} size="compact-xs" variant="default" onClick={() => stage?.lookFrom(side)}>
            {name}
          </Button>
        ))}
      </div>
      <div className={classes.legend} aria-hidden>
        <span>
          <span style={{ color: BOARD_COLORS.fitted }}>▭</span> board, fitted to
        </span>
        <span>
          <span style={{ color: BOARD_COLORS.leftOut }}>▭</span> board, left out
        </span>
      </div>
      {failure && <Text role="alert">{failure}</Text>}
    </div>
  );
}
