/** Two runs side by side: what was asked of each, and where that differs. */

import type { FormField, Job, JobForm } from "../api/types";
import { formatName } from "./format";

export interface ParamRow {
  name: string;
  label: string;
  first: string;
  second: string;
  isDifferent: boolean;
}

/** What the options of a training are called; their names serve programs. */
const TRAINING_LABELS: Readonly<Record<string, string>> = {
  rounds: "Rounds of training",
  num_shapes: "Shapes of the whole hand",
  num_local_shapes: "Shapes of parts of the hand",
  with_pose_shapes: "Pose blend shapes",
  with_mirrored: "Left hands, mirrored",
};

/** Parameters one by one, as people read them: those inside others too, and no id beside the name of the same thing. */
export function describeParams(params: Readonly<Record<string, unknown>>, form?: JobForm): [label: string, value: string][] {
  const { options, ...rest } = params;
  const fields = listFields(form);
  const training = typeof options === "object" && options !== null ? listParams(options as Record<string, unknown>) : [];
  return [
    ...listParams(rest).map(([name, value]): [string, string] => [fields.get(name)?.label ?? formatName(name), showParam(fields.get(name), value)]),
    ...training.map(([name, value]): [string, string] => [TRAINING_LABELS[name] ?? formatName(name), showValue(value)]),
  ];
}

/** A value as people read it. */
export function showValue(value: unknown): string {
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return value.length === 0 ? "–" : value.map(showValue).join(", ");
  return value === undefined || value === "" || value === null ? "–" : typeof value === "string" ? value : JSON.stringify(value);
}

/** The same of an option of the form: a choice by its words, and no number that only programs understand. */
function showParam(field: FormField | undefined, value: unknown): string {
  if (field?.name === "last_frame" && value === -1) return "the recording's last";
  return (typeof value === "string" && field?.choice_labels?.[field.choices?.indexOf(value) ?? -1]) || showValue(value);
}

const listFields = (form: JobForm | undefined): Map<string, FormField> => new Map(form?.fields.map((field) => [field.name, field]));

/** Every parameter of either, in the order of the form; the ones that differ first. */
export function compareParams(first: Job, second: Job, form: JobForm | undefined): ParamRow[] {
  const fields = listFields(form);
  const names = [...new Set([...fields.keys(), ...Object.keys(first.params), ...Object.keys(second.params)])];
  const rows = names
    .filter((name) => name in first.params || name in second.params)
    .map((name) => {
      const [a, b] = [first.params[name], second.params[name]];
      return { name, label: fields.get(name)?.label ?? formatName(name), first: showParam(fields.get(name), a), second: showParam(fields.get(name), b), isDifferent: JSON.stringify(a) !== JSON.stringify(b) };
    });
  return [...rows.filter((row) => row.isDifferent), ...rows.filter((row) => !row.isDifferent)];
}

function listParams(params: Readonly<Record<string, unknown>>): [name: string, value: unknown][] {
  return Object.entries(params).flatMap(([name, value]): [string, unknown][] => {
    if (name.endsWith("_id") && name.slice(0, -3) in params) return [];
    return typeof value === "object" && value !== null && !Array.isArray(value) ? listParams(value as Record<string, unknown>) : [[name, value]];
  });
}
