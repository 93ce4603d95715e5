/** What the import page's fields hold, and what they mean to the server. */

import type { ImportOptions } from "../api/imports";
import type { ImportQuestion, SensorFit } from "../api/types";

/** As typed: a number that is being typed may not be one yet. */
export type Draft = Record<string, string | number | boolean | string[] | undefined>;

const NUMBERS = ["fx", "fy", "cx", "cy", "depth_scale", "world_unit_m", "object_unit_m", "fps"] as const;

export interface NumberField {
  name: (typeof NUMBERS)[number];
  label: string;
  unit: string;
  hint: string;
}

const FIELDS: readonly NumberField[] = [
  { name: "fx", label: "Focal length fx", unit: "px", hint: "Along x" },
  { name: "fy", label: "Focal length fy", unit: "px", hint: "As fx when empty" },
  { name: "cx", label: "Principal point cx", unit: "px", hint: "About half the width" },
  { name: "cy", label: "Principal point cy", unit: "px", hint: "About half the height" },
  { name: "depth_scale", label: "Depth unit", unit: "m", hint: "0.001 for millimetres" },
  { name: "world_unit_m", label: "Unit of the calibration", unit: "m", hint: "Such as a square's side" },
  { name: "fps", label: "Frames per second", unit: "", hint: "30 when nobody knows" },
];

/** The numbers that matter to this import, in a fixed order. */
export const numberFields = (takes: readonly string[]): NumberField[] => FIELDS.filter(({ name }) => takes.includes(name));

const isNumber = (name: string): boolean => (NUMBERS as readonly string[]).includes(name);

/** While it is being typed, "0." is on the way to 0.001; only a principal point can be 0. */
const isUnfinished = (name: string, value: unknown): boolean => Number(value) === 0 && (typeof value === "string" || !["cx", "cy"].includes(name));

/** Only what was said; a number that cannot be read yet is left out. */
export function toOptions(draft: Draft): ImportOptions {
  const options: ImportOptions = {};
  for (const [name, value] of Object.entries(draft)) {
    if (value === undefined || value === "" || value === false) continue;
    if (isNumber(name) && isUnfinished(name, value)) continue;
    const told = isNumber(name) ? Number(value) : value;
    if (typeof told !== "number" || Number.isFinite(told)) options[name] = told;
  }
  return options;
}

/** One text for options that mean the same. */
export const optionsKey = (options: ImportOptions): string =>
  JSON.stringify(Object.entries(toOptions(options)).sort(([a], [b]) => (a < b ? -1 : 1)));

/** What is still to be told: nothing is stored before. */
export const stillNeeded = (questions: readonly ImportQuestion[]): ImportQuestion[] => questions.filter(({ is_required }) => is_required);

/** Problems that no field of the form mends. */
export const withoutField = (problems: readonly string[], questions: readonly ImportQuestion[]): string[] =>
  problems.filter((problem) => !questions.some((question) => question.problem === problem));

/** The draft with a sensor's typical values in its fields; what somebody typed is replaced, except the frame rate. */
export function withSensor(draft: Draft, sensor: SensorFit): Draft {
  const { fps, ...values } = sensor.values;
  return { ...draft, ...values, fps: draft["fps"] === undefined || draft["fps"] === "" ? fps : draft["fps"], preset: sensor.name };
}
