/** Rows of marks over the frames of a recording, drawn on one small canvas. Pure: what to draw, and on what. */

export interface StripRow {
  readonly label: string;
  /** One colour, or one for each value. */
  readonly color: string | ((value: number) => string);
  /** One value per frame; 0 draws nothing, 1 the full height. */
  readonly values: ArrayLike<number>;
}

export interface StripColors {
  readonly ground: string;
  readonly cursor: string;
}

/** Largest value of the frames that share a pixel column, so that a single mark is never lost in a long recording. */
export function columnMaxima(values: ArrayLike<number>, columns: number): Float32Array {
  const maxima = new Float32Array(columns);
  const count = values.length;
  if (count === 0) return maxima;
  for (let column = 0; column < columns; column += 1) {
    const first = Math.floor((column * count) / columns);
    const last = Math.max(first + 1, Math.ceil(((column + 1) * count) / columns));
    for (let index = first; index < last && index < count; index += 1) maxima[column] = Math.max(maxima[column] ?? 0, values[index] ?? 0);
  }
  return maxima;
}

export const frameAtX = (x: number, width: number, frameCount: number): number =>
  Math.min(frameCount - 1, Math.max(0, Math.floor((x / width) * frameCount)));

export function drawStrip(
  context: CanvasRenderingContext2D,
  rows: readonly StripRow[],
  frame: number | null,
  frameCount: number,
  size: { width: number; height: number },
  colors: StripColors,
): void {
  const { width, height } = size;
  const gap = 2;
  const rowHeight = (height - gap * (rows.length - 1)) / Math.max(1, rows.length);
  context.clearRect(0, 0, width, height);
  rows.forEach((row, index) => {
    const top = index * (rowHeight + gap);
    context.fillStyle = colors.ground;
    context.fillRect(0, top, width, rowHeight);
    columnMaxima(row.values, Math.round(width)).forEach((value, x) => {
      context.fillStyle = typeof row.color === "string" ? row.color : row.color(value);
      if (value > 0) context.fillRect(x, top + rowHeight * (1 - value), 1, rowHeight * value);
    });
  });
  if (frame !== null && frameCount > 0) {
    const step = width / frameCount;
    const x = frame * step;
    context.fillStyle = colors.cursor;
    context.globalAlpha = 0.22;
    context.fillRect(x, 0, Math.max(step, 2), height);
    context.globalAlpha = 1;
    context.fillRect(Math.min(width - 2, x + step / 2 - 1), 0, 2, height);
  }
}
