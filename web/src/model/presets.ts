/** Which preset the values of a job's form amount to. */

import type { JobForm, Preset } from "../api/types";

/** Values that differ from their defaults. */
export type Changed = Record<string, unknown>;

/** The preset whose method this is, or null for one's own. Frames, camera and threads belong to no preset. */
export function matchPreset(form: JobForm, changed: Changed): Preset | null {
  const method = form.fields.filter((field) => field.about === "method");
  const has = (preset: Preset): boolean =>
    method.every((field) => (changed[field.name] ?? field.default) === (preset.values[field.name] ?? field.default));
  return form.presets.find(has) ?? null;
}

/** The values after a preset was chosen: its method, everything else as it was. */
export function choosePreset(form: JobForm, changed: Changed, preset: Preset): Changed {
  const kept = form.fields.filter((field) => field.about !== "method" && field.name in changed).map((field) => [field.name, changed[field.name]]);
  const set = form.fields.filter((field) => field.name in preset.values && preset.values[field.name] !== field.default);
  return Object.fromEntries([...kept, ...set.map((field) => [field.name, preset.values[field.name]])]) as Changed;
}
