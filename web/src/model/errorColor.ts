/** Errors are blue when small and red when large, with the same scale everywhere. */

/** Depth residual at which the scale ends, mm. */
export const ERROR_FULL_MM = 10;

/** Distance between a scan and its mesh at which the scale ends, mm. */
export const SCAN_ERROR_FULL_MM = 3;

/** Red, green and blue, 0..255, evenly spaced over the scale. */
export const ERROR_ANCHORS = [
  [62, 118, 208],
  [98, 170, 200],
  [226, 205, 120],
  [232, 122, 74],
  [214, 48, 49],
] as const;

/** Colour of an error, 0 (none) to 1 (the scale's end). */
export function errorColor(value: number): string {
  const at = Math.min(1, Math.max(0, value)) * (ERROR_ANCHORS.length - 1);
  const below = Math.min(ERROR_ANCHORS.length - 2, Math.floor(at));
  const [from, to] = [ERROR_ANCHORS[below], ERROR_ANCHORS[below + 1]];
  if (!from || !to) return "#888888";
  const [r, g, b] = [0, 1, 2].map((channel) => Math.round((from[channel] ?? 0) + ((to[channel] ?? 0) - (from[channel] ?? 0)) * (at - below)));
  return `rgb(${r} ${g} ${b})`;
}

/** The scale as a CSS background. */
export const errorGradient = `linear-gradient(90deg, ${ERROR_ANCHORS.map((color) => `rgb(${color.join(" ")})`).join(", ")})`;
