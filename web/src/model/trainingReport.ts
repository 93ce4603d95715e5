/** What a training's report says, read with care: it comes as free JSON and grows with the program. */

type Json = Record<string, unknown>;

const isRecord = (value: unknown): value is Json => typeof value === "object" && value !== null && !Array.isArray(value);
const numberOf = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);
const numbersOf = (value: unknown): number[] => (Array.isArray(value) ? value.flatMap((one) => numberOf(one) ?? []) : []);
const textsOf = (value: unknown): string[] => (Array.isArray(value) ? value.filter((one) => typeof one === "string") : []);

/** One bar of a chart. */
export interface NamedValue {
  readonly name: string;
  readonly value: number;
  readonly count: number | null;
}

/** A figure of a model of so many components, as Fig. 12 to 14 of [R17] draw it. */
export interface ComponentCurve {
  readonly components: readonly number[];
  readonly values: readonly number[];
}

export interface NamedCurve {
  readonly name: string;
  readonly curve: ComponentCurve;
}

/** How near models come to people they were not trained on, mm. */
export interface Compared {
  readonly scanToMesh: readonly NamedValue[];
  readonly vertices: readonly NamedValue[];
}

/** What a model was judged by once it was trained. */
export interface HeldOutStudy {
  readonly people: readonly string[];
  readonly scans: number;
  /** How near the registrations themselves lie to the scans, mm. */
  readonly floorMm: number | null;
  /** With pose and shape fitted. */
  readonly models: Compared;
  /** With a template of their own, the pose fitted. */
  readonly ownTemplate: Compared;
  readonly poseGeneralisation: readonly NamedCurve[];
  /** What could not be compared, and why. */
  readonly notCompared: readonly { readonly name: string; readonly why: string }[];
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
  /** Mean error of templates of people left out in turn, by number of components, mm; empty when not measured. */
  readonly shapeGeneralisation: ComponentCurve;
  /** Null when nobody was kept for testing. */
  readonly heldOut: HeldOutStudy | null;
  readonly byHand: readonly NamedValue[];
  readonly byPose: readonly NamedValue[];
  readonly seconds: readonly NamedValue[];
}

const NOTHING: ComponentCurve = { components: [], values: [] };

/** Shares that the first 1, 2, .. components hold together, as the report has them. */
const sharesOf = (value: unknown): ComponentCurve => {
  const values = numbersOf(value);
  return { components: values.map((_, at) => at + 1), values };
};

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

/** `{"learned": {"scan_to_mesh_mm": 0.4, "vertices_mm": 0.6}, ..}`. */
function comparedOf(value: unknown): Compared {
  const rows = isRecord(value) ? Object.entries(value) : [];
  const take = (key: string): NamedValue[] =>
    rows.flatMap(([name, one]) => {
      const mean = isRecord(one) ? numberOf(one[key]) : null;
      return mean === null ? [] : [{ name, value: mean, count: null }];
    });
  return { scanToMesh: take("scan_to_mesh_mm"), vertices: take("vertices_mm") };
}

function heldOutOf(study: Json): HeldOutStudy | null {
  const models = comparedOf(study["models"]);
  if (models.scanToMesh.length === 0) return null;
  const curves = isRecord(study["pose_generalisation"]) ? Object.entries(study["pose_generalisation"]) : [];
  const refused = isRecord(study["not_compared"]) ? Object.entries(study["not_compared"]) : [];
  return {
    people: textsOf(study["people"]),
    scans: numberOf(study["scans"]) ?? 0,
    floorMm: numberOf(study["floor_mm"]),
    models,
    ownTemplate: comparedOf(study["own_template"]),
    poseGeneralisation: curves.map(([name, rows]) => ({ name, curve: curveOf(rows) })).filter(({ curve }) => curve.values.length > 0),
    notCompared: refused.map(([name, why]) => ({ name, why: String(why) })),
  };
}

export function readReport(report: Json): TrainingReport {
  const study = isRecord(report["study"]) ? report["study"] : {};
  return {
    registrations: numberOf(report["registrations"]),
    people: numberOf(report["people"]),
    residualMm: numberOf(report["residual_mm"]),
    roundsMm: numbersOf(report["rounds_mm"]),
    shapeCompactness: sharesOf(report["shape_space"]),
    poseCompactness: sharesOf(report["pose_space"]),
    shapeGeneralisation: curveOf(study["shape_generalisation"]),
    heldOut: heldOutOf(study),
    byHand: groupOf(report["by_hand"]),
    byPose: groupOf(report["by_pose"]),
    seconds: groupOf(report["seconds"]),
  };
}
