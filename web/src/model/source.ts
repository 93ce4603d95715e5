/** Where joints came from, and which of them count. */

import type { JointSource } from "../api/types";
import type { components } from "../api/schema";
import type { JointPoint } from "./pose";

export type JointsOfSource = components["schemas"]["JointsOfSource"];

/** Joints that no track had a part in: what judges when nobody chose. */
export const INDEPENDENT = "independent";
export const ALL_SOURCES = "all";

export const SOURCE_CHOICES: readonly { value: string; label: string }[] = [
  { value: "hand", label: "Placed by hand" },
  { value: "unknown", label: "Never noted" },
  { value: "import", label: "Imported" },
  { value: "triangulation", label: "Other cameras" },
  { value: "interpolation", label: "Key frames" },
  { value: "copy", label: "Copied" },
  { value: "fit", label: "Model fit" },
  { value: "track", label: "Track" },
  { value: "detector", label: "Hand detector" },
];

/** No track, no model fit and no hand detector had a part in the joint; what is made of such joints alone says so. */
export const isIndependent = (from: JointSource | undefined): boolean => from === undefined || from.kind === "import" || from.is_independent === true;

/** To be spread into the source of a joint that is made of others. */
export const ofIndependent = (...parts: readonly JointPoint[]): { is_independent?: true } => (parts.length > 0 && parts.every((part) => isIndependent(part.from)) ? { is_independent: true } : {});

/** "85 joints are left out: 64 accepted from Track 1, 21 accepted from a model fit." Empty where all count. */
export function describeLeftOut(sources: readonly JointsOfSource[]): string {
  const left = sources.filter((one) => !one.is_counted);
  const joints = left.reduce((sum, one) => sum + one.joints, 0);
  if (joints === 0) return "";
  return `${joints} ${joints === 1 ? "joint is" : "joints are"} left out: ${left.map((one) => `${one.joints} ${one.words}`).join(", ")}.`;
}
