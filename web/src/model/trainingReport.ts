/** What a training's report says, read with care: it comes as free JSON and grows with the program. */

type Json = Record<string, unknown>;

const isRecord = (value: unknown): value is Json => typeof value === "object" && value !== null && !Array.isArray(value);
const numberOf = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);
const numbersOf = (value: unknown): number[] => (Array.isArray(value) ? value.flatMap((one) => numberOf(one) ?? []) : []);

/** One bar of a chart. */
export interface NamedValue {
  readonly name: string;
  readonly value: number;
  readonly count: number | null;
}

/** A figure of a model of so many components, as Fig. 12 and 13 of [R17] draw it. */
export interface ComponentCurve {
  readonly components: readonly number[];
  readonly values: readonly number[];
}

export interface TrainingReport {
  readonly registrations: number | null;
  readonly people: number | null;
  readonly residualMm: number | null;
  /** Distance of the model to its registrations after each pass. */
  readonly roundsMm: readonly number[];
  /** Share of the variance that the first components hold together, 0..1. */
  readonly shapeCompactness: ComponentCurve;
  readonly poseCompactness: ComponentCurve;
  /** Mean error on hands that were kept out, by number of components, mm; empty when that was not measured. */
  readonly shapeGeneralisation: ComponentCurve;
  readonly poseGeneralisation: ComponentCurve;
  /** Models compared on hands that were kept out, mm: learned, blend shapes off, skinning only, untrained. */
  readonly comparison: readonly NamedValue[];
  readonly byHand: readonly NamedValue[];
  readonly byPose: readonly NamedValue[];
  readonly seconds: readonly NamedValue[];
}

const NOTHING: ComponentCurve = { components: [], values: [] };

/** Shares of the variance, one a component, as they add up. */
export function cumulative(shares: readonly number[]): ComponentCurve {
  let sum = 0;
  return { components: shares.map((_, at) => at + 1), values: shares.map((share) => (sum += share)) };
}

function groupOf(value: unknown): NamedValue[] {
  if (!isRecord(value)) return [];
  return Object.entries(value)
    .flatMap(([name, one]) => {
      const residual = isRecord(one) ? numberOf(one["residual_mm"]) : numberOf(one);
      return residual === null ? [] : [{ name, value: residual, count: isRecord(one) ? numberOf(one["registrations"]) : null }];
    })
    .sort((a, b) => b.value - a.value);
}

/** `[{"components": 5, "mean_mm": 1.2}, ..]`, as `tracker/evaluation/model_study.py` measures it. */
function curveOf(value: unknown): ComponentCurve {
  if (!Array.isArray(value)) return NOTHING;
  const rows = value.flatMap((row: unknown) => {
    const [components, mean] = isRecord(row) ? [numberOf(row["components"]), numberOf(row["mean_mm"])] : [null, null];
    return components === null || mean === null ? [] : [{ components, mean }];
  });
  return { components: rows.map((row) => row.components), values: rows.map((row) => row.mean) };
}

/** `{"learned": {"scan_to_mesh_mm": 0.4}, ..}`. */
function comparisonOf(value: unknown): NamedValue[] {
  if (!isRecord(value)) return [];
  return Object.entries(value).flatMap(([name, one]) => {
    const mean = isRecord(one) ? numberOf(one["scan_to_mesh_mm"]) : null;
    return mean === null ? [] : [{ name, value: mean, count: null }];
  });
}

export function readReport(report: Json): TrainingReport {
  const study = isRecord(report["study"]) ? report["study"] : {};
  return {
    registrations: numberOf(report["registrations"]),
    people: numberOf(report["people"]),
    residualMm: numberOf(report["residual_mm"]),
    roundsMm: numbersOf(report["rounds_mm"]),
    shapeCompactness: cumulative(numbersOf(report["shape_space"])),
    poseCompactness: cumulative(numbersOf(report["pose_space"])),
    shapeGeneralisation: curveOf(study["shape_generalisation"]),
    poseGeneralisation: curveOf(study["pose_generalisation"]),
    comparison: comparisonOf(study["models"]),
    byHand: groupOf(report["by_hand"]),
    byPose: groupOf(report["by_pose"]),
    seconds: groupOf(report["seconds"]),
  };
}
