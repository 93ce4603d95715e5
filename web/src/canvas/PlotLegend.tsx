import type { Curve } from "./series";
import classes from "./Plot.module.css";

interface PlotLegendProps {
  curves: readonly Curve[];
  /** Whose values are shown; -1 for none. */
  index: number;
}

/** The names of curves, how they are drawn, and their values at one place. */
export function PlotLegend({ curves, index }: PlotLegendProps) {
  return (
    <div className={classes.legend}>
      {curves.map((curve) => {
        const value = index >= 0 ? curve.values[index] : null;
        return (
          <span key={curve.label} className={classes.entry}>
            <svg width="18" height="8" aria-hidden>
              {curve.isSparse ? (
                <circle cx="9" cy="4" r="3" fill={curve.color} />
              ) : (
                <line x1="0" y1="4" x2="18" y2="4" stroke={curve.color} strokeWidth="2" strokeDasharray={curve.dash?.join(" ")} />
              )}
            </svg>
            {curve.label}
            <strong>{value === null || value === undefined ? "–" : `${value.toFixed(curve.digits ?? 1)}${curve.unit ? ` ${curve.unit}` : ""}`}</strong>
          </span>
        );
      })}
    </div>
  );
}
