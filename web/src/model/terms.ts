/** How the terms of the objective are told apart in curves: hue and dash, as near to the 3D view as a white page allows. */

interface TermStyle {
  readonly color: string;
  readonly dash?: number[];
}

const STYLES: Record<string, TermStyle> = {
  model_to_data: { color: "#16a3bd" },
  data_to_model: { color: "#e83eb4", dash: [6, 3] },
  data_to_surface: { color: "#7aae1c" },
  silhouette: { color: "#d69a00", dash: [2, 3] },
  collision: { color: "#ff5a4d" },
  salient: { color: "#8f9baa", dash: [6, 3] },
  physics: { color: "#9775fa", dash: [8, 3, 2, 3] },
  anatomy: { color: "#cf7f4f", dash: [4, 2] },
  regularization: { color: "#6f86e8", dash: [2, 2] },
};

const SPARE: readonly TermStyle[] = [{ color: "#3f9f86", dash: [8, 4] }, { color: "#b0713a", dash: [1, 3] }];

/** One that is not listed gets a spare that depends on its name only. */
export function termStyle(term: string): TermStyle {
  const sum = [...term].reduce((total, letter) => total + letter.charCodeAt(0), 0);
  return STYLES[term] ?? SPARE[sum % SPARE.length] ?? { color: "#999999" };
}
