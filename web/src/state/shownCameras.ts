/** Which cameras' pictures are shown side by side: in the address, and remembered for each recording. */

export const MAX_SHOWN = 8;
const SHOWN_AT_FIRST = 4;

/** By names, the most wanted choice first: that of the address or of the last click, then that of last time. */
export type WantedCameras = readonly (readonly string[])[];

/** The first choice that the recording has any cameras of, else its first ones; the active one is always among them. */
export function chooseShown(cameras: readonly string[], wanted: WantedCameras, active: string): string[] {
  const known = (names: readonly string[]): string[] => cameras.filter((camera) => names.includes(camera));
  const chosen = [...wanted, cameras.slice(0, SHOWN_AT_FIRST)].map(known).find((names) => names.length > 0) ?? [];
  const shown = chosen.slice(0, MAX_SHOWN);
  if (shown.includes(active) || !cameras.includes(active)) return shown;
  // Alone with another one means "this camera": then the active one takes its place.
  return shown.length <= 1 ? [active] : known([...shown.slice(0, MAX_SHOWN - 1), active]);
}
