import { useMemo } from "react";
import type { CalibrationResult, PlacedBoard } from "../../api/calibrations";
import { Plot } from "../../canvas/Plot";
import type { Curve } from "../../canvas/series";
import { trackStyle } from "../../model/trackStyle";
import classes from "./calibrations.module.css";

interface BoardPlotProps {
  result: CalibrationResult;
  boards: readonly PlacedBoard[];
}

/** How far each camera's corners are off at each moment that was judged. */
export function BoardPlot({ result, boards }: BoardPlotProps) {
  const inTime = useMemo(() => [...boards].sort((a, b) => a.seconds - b.seconds), [boards]);
  const curves = useMemo<Curve[]>(
    () =>
      result.cameras.map(({ id }, place) => ({
        ...trackStyle(place),
        label: id,
        unit: "px",
        values: inTime.map((board) => board.residual_px[id]?.rms ?? null),
        axis: "Residual, px",
        digits: 2,
        hasDots: true,
      })),
    [result, inTime],
  );
  return (
    <div className={`card ${classes.plot}`}>
      <Plot label="Residual of each board by second" frames={inTime.map(({ seconds }) => seconds)} curves={curves} lost={[]} frame={null} joinsAll />
    </div>
  );
}
