/** What a plot makes of its curves: where lines break, which values stand alone, and which axis measures what. No drawing. */

export interface Curve {
  readonly label: string;
  readonly unit: string;
  readonly values: readonly (number | null)[];
  readonly color: string;
  /** Dashes tell curves apart without colour. */
  readonly dash?: number[];
  /** What its axis measures, with the unit: "Depth residual, mm". Curves with the same words share an axis. */
  readonly axis: string;
  readonly digits?: number;
  /** Single values, shown as dots. */
  readonly isSparse?: boolean;
  /** Dots on the line: few values, between which nothing was measured. */
  readonly hasDots?: boolean;
}

/** Places of values that follow one another on the curve without being neighbours: no line may join the two. */
export function breaksOf(frames: readonly number[], values: readonly (number | null | undefined)[]): [number, number][] {
  const found: [number, number][] = [];
  let last = -1;
  values.forEach((value, place) => {
    if (value === null || value === undefined) return;
    if (last >= 0 && (frames[place] ?? 0) - (frames[last] ?? 0) > 1) found.push([last, place]);
    last = place;
  });
  return found;
}

/** Places of values that have no neighbour, so that no line shows them: each needs a dot. */
export function loneOf(frames: readonly number[], values: readonly (number | null | undefined)[]): number[] {
  const places = values.flatMap((value, place) => (value === null || value === undefined ? [] : [place]));
  const isNear = (a: number | undefined, b: number | undefined): boolean => a !== undefined && b !== undefined && (frames[b] ?? 0) - (frames[a] ?? 0) <= 1;
  return places.filter((place, index) => !isNear(places[index - 1], place) && !isNear(place, places[index + 1]));
}

/** The axes of a plot, the left one first. Two units never share one, and a third one belongs into a plot of its own. */
export function axesOf(curves: readonly Pick<Curve, "axis" | "unit">[]): string[] {
  const axes = [...new Set(curves.map((curve) => curve.axis))];
  for (const axis of axes) {
    const units = [...new Set(curves.filter((curve) => curve.axis === axis).map((curve) => curve.unit))];
    if (units.length > 1) throw new Error(`The axis “${axis}” would hold ${units.join(" and ")}: give each unit its own axis.`);
  }
  if (axes.length > 2) throw new Error(`A plot has two axes, not ${axes.length} (${axes.join("; ")}): draw the others in a plot of their own.`);
  return axes;
}
