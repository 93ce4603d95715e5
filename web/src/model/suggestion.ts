/** What a machine proposes for one hand in one image. Never a `Pose`: only a person's gesture makes one of it. */

import { JOINT_COUNT } from "./joints";
import type { JointSource } from "../api/types";
import { emptyPose, keyText, statusOf, type JointPoint, type Pose, type PoseKey } from "./pose";

/** Where suggestions come from; where several have a joint, the first of these is shown. */
export const SOURCES = ["triangulation", "interpolation", "fit", "track", "detector"] as const;
export type Source = (typeof SOURCES)[number];

export const SOURCE_NAMES: Record<Source, string> = {
  triangulation: "Other cameras",
  interpolation: "Key frames",
  fit: "Model fit",
  track: "Track",
  detector: "Hand detector",
};

/** A proposed joint. Its visibility is a guess, and is named so: no `JointPoint` by accident. */
export interface SuggestedJoint {
  /** px, (0, 0) is the centre of the top-left pixel */
  readonly px: readonly [number, number];
  readonly guess: "occluded" | "visible";
  /** Of a joint made of others: no track, no model fit and no detector had a part in any of them. */
  readonly is_independent?: true;
}

export interface Suggestion {
  readonly source: Source;
  /** For people, after "Suggested by": "Track 2", "model fit of 7 joints". */
  readonly label: string;
  readonly place: PoseKey;
  /** The track it is of, and the hand model behind it, where there are such. */
  readonly trackId?: string | null;
  readonly model?: string;
  /** 21; null where nothing is proposed. */
  readonly joints: readonly (SuggestedJoint | null)[];
}

/** The suggestions of one hand that are in play, by source. */
export type SuggestionsOfHand = Readonly<Partial<Record<Source, Suggestion>>>;

/** A proposed joint that knows who proposes it. */
export interface Proposed extends SuggestedJoint {
  readonly from: JointSource;
}

/** What is drawn and can be accepted: for each joint that nobody has decided about the proposal of the first source that has one. */
export interface OpenJoint extends Proposed {
  readonly source: Source;
}

export function openJoints(suggestions: SuggestionsOfHand | undefined, pose: Pose | undefined, hidden: ReadonlySet<Source>): (OpenJoint | null)[] {
  const shown = suggestions ? SOURCES.filter((source) => !hidden.has(source)).flatMap((source) => suggestions[source] ?? []) : [];
  return Array.from({ length: JOINT_COUNT }, (_, joint) => {
    if (statusOf(pose?.[joint]) !== "unset") return null;
    for (const suggestion of shown) {
      const found = suggestion.joints[joint];
      if (found) return { ...found, source: suggestion.source, from: sourceOf(suggestion, found) };
    }
    return null;
  });
}

/** What is kept beside a label that a person made of it. */
export const sourceOf = ({ source, label, trackId, model }: Suggestion, joint: SuggestedJoint): JointSource => ({
  kind: source,
  label,
  ...(trackId ? { track_id: trackId } : {}),
  ...(model ? { model } : {}),
  ...(joint.is_independent ? { is_independent: true } : {}),
});

/** The one place where a proposal becomes a label: a person asked for it. */
const accept = ({ px: [x, y], guess, from }: Proposed): JointPoint => ({ x, y, v: guess === "occluded" ? 1 : 2, from });

/** The pose with some proposals taken over; what somebody decided before stays as it is. */
export const withAccepted = (pose: Pose | undefined, open: readonly (Proposed | null)[], only?: number): Pose =>
  (pose ?? emptyPose()).map((point, joint) => {
    const proposed = open[joint];
    return proposed && statusOf(point) === "unset" && (only === undefined || only === joint) ? accept(proposed) : point;
  });

/** The proposals as a shape to draw; absent joints are unset. */
export const asShape = (open: readonly (Proposed | null)[]): Pose => emptyPose().map((unset, joint) => (open[joint] ? accept(open[joint]) : unset));

export const placeText = (suggestion: Suggestion): string => keyText(suggestion.place);
