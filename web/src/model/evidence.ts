/** What the 3D view's layers say of a frame, in one sentence each. */

import type { ViewerSession } from "../api/types";
import { formatCount, formatNumber } from "./format";

type Detections = NonNullable<ViewerSession["detections"]>;
type Collisions = NonNullable<ViewerSession["collisions"]>;
type Unknown = NonNullable<ViewerSession["unknown"]>;
type Contacts = NonNullable<ViewerSession["contacts"]>;

/** Displacement at which physics calls an object fallen, mm. */
export const STABLE_BELOW_MM = 3;

const SIMULATION_ENDS_MM = 30;

const mm = (value: number): string => `${formatNumber(value)} mm`;

export function describeDetections({ items }: Detections): string {
  if (items.length === 0) return "No fingertip was found in this image: the fingers are bent, hidden or too far away.";
  const owned = items.filter((item) => item.finger !== null).length;
  const rest = items.length - owned;
  return `${formatCount(owned, "detection")} of a fingertip${rest > 0 ? `, ${rest} that no fingertip is near enough to` : ""}.`;
}

export function describeCollisions({ pairs, vertices, deepest_mm: deepest }: Collisions): string {
  if (pairs.length === 0) return "Nothing intersects here.";
  if (vertices === 0) return "Surfaces touch and cross; no vertex is inside.";
  return `${formatCount(vertices, "vertex is", "vertices are")} inside, ${mm(deepest)} deep at most.`;
}

export function describeContacts({ fault, object, is_stable: isStable, displacement_mm: moved, held_displacement_mm: held, parts }: Contacts): string {
  if (fault !== null) return fault;
  if (object === null) return "There is nothing to hold: physics needs an object and a hand.";
  const thing = `The ${object.replaceAll("_", " ")}`;
  if (isStable) return `${thing} is held: simulated, it moves ${mm(moved)} (less than ${STABLE_BELOW_MM} mm).`;
  const falls = moved >= SIMULATION_ENDS_MM ? `${thing} falls` : `${thing} slips by ${mm(moved)}`;
  if (parts.length === 0) return `${falls}: no finger part is within 10 mm of it.`;
  if (parts.some((part) => part.is_chosen)) return `${falls}; with the chosen parts in contact it moves ${mm(held)}.`;
  return `${falls}, and no combination of the parts near it would hold it.`;
}

export function describeUnknown({ pixels, before, by_color: byColor }: Unknown): string {
  const told = pixels === 0 ? "Nothing near the hands was left out here." : `${formatCount(pixels, "pixel was", "pixels were")} left out; ${before > 0 ? before.toLocaleString("en") : "none"} of them hide${before === 1 ? "s" : ""} the hand.`;
  return byColor ? told : `${told} Without colour, only things in front of the hand can be distinguished from it.`;
}

/** That a layer shows what the run itself did without; null if it did not. */
export function describeOrigin(layer: "detections" | "collisions" | "contacts", isOfRun: boolean, ownDetector: string | null = null): string | null {
  const terms = { detections: "fingertips (S)", collisions: "collision (C)", contacts: "physics (P)" } as const;
  if (!isOfRun) return `Computed now. This run did not use ${terms[layer]}.`;
  if (ownDetector !== null) return `Found by “${ownDetector}”, at which the run looked in every frame.`;
  return layer === "detections" ? "The run itself looks at them only where a frame goes badly." : null;
}

/** What stands beside a layer's name; null while it is off or not known. */
export function countOf(told: ViewerSession | null, layer: string): string | null {
  if (!told) return null;
  const count = (value: number): string => (value < 1000 ? String(value) : `${(value / 1000).toFixed(1)}k`);
  switch (layer) {
    case "correspondences":
      return told.terms.length > 0 ? count(told.terms.reduce((sum, term) => sum + term.count, 0)) : null;
    case "detections":
      return told.detections && count(told.detections.items.length);
    case "collisions":
      return told.collisions && count(told.collisions.triangles);
    case "contacts":
      return told.contacts && count(told.contacts.parts.length);
    default:
      return null;
  }
}
