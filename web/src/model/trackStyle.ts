/** How tracks that are compared are told apart: by colour and by dashes, alike in tables, curves and reports. */

/** As in `tracker/evaluation/report_drawing.py`. */
const COLORS = ["#1c9c8f", "#d9822b", "#7d6bd8", "#3d86d8", "#c2547e", "#7c8a2e", "#8a8f98", "#b0553a"] as const;
const DASHES: readonly (number[] | undefined)[] = [undefined, [7, 4], [2, 3], [9, 3, 2, 3], [4, 2], [12, 4], [1, 4], [6, 2, 1, 2]];

export interface TrackStyle {
  color: string;
  dash?: number[];
}

export function trackStyle(place: number): TrackStyle {
  const color = COLORS[place % COLORS.length] ?? COLORS[0];
  const dash = DASHES[place % DASHES.length];
  return dash ? { color, dash } : { color };
}
