/** What several cameras' marks say together: which can be triangulated, what that suggests elsewhere, how far they are off. */

import type { MarkedView, TriangulatedJoint, TriangulatedView, Triangulation } from "../api/triangulation";
import type { Side } from "../api/types";
import { JOINT_COUNT } from "./joints";
import { isPlaced, keyText, toWire, type JointPoint, type Pose, type PoseKey } from "./pose";
import { ofIndependent } from "./source";
import type { SuggestedJoint, Suggestion } from "./suggestion";

/** As many views as the server takes. */
const MAX_VIEWS = 16;

type Poses = Readonly<Record<string, Pose>>;

/** The active hand in every camera that has a mark of it in this frame. */
export function markedViews(poses: Poses, cameras: readonly string[], frame: number, hand: Side): MarkedView[] {
  return cameras
    .flatMap((camera) => {
      const pose = poses[keyText({ camera, frame, hand })];
      return pose?.some(isPlaced) ? [{ camera, points: toWire(pose) }] : [];
    })
    .slice(0, MAX_VIEWS);
}

/** Whether any joint is marked in two views. */
export const canTriangulate = (views: readonly MarkedView[]): boolean =>
  Array.from({ length: JOINT_COUNT }, (_, joint) => views.filter(({ points }) => (points[joint]?.[2] ?? 0) > 0).length).some((count) => count >= 2);

/** The joints as the other views should see them; what lies outside an image is not suggested there. */
export function suggestViews(found: Triangulation, views: readonly MarkedView[], { frame, hand }: Omit<PoseKey, "camera">, poses: Poses): Suggestion[] {
  const cameras = found.joints[0]?.views.map((view) => view.camera) ?? [];
  const from = views.map((view) => view.camera);
  const marksOf = (joint: number): JointPoint[] => from.flatMap((camera) => poses[keyText({ camera, frame, hand })]?.[joint] ?? []).filter(isPlaced);
  return cameras.flatMap((camera): Suggestion[] => {
    const own = views.find((view) => view.camera === camera);
    const joints = found.joints.map(({ views: all }, joint): SuggestedJoint | null => {
      const view = all.find((one) => one.camera === camera);
      const isMarked = (own?.points[joint]?.[2] ?? 0) > 0;
      return view && view.is_seen && !isMarked && view.x !== null && view.y !== null ? { px: [view.x, view.y], guess: "visible", ...ofIndependent(...marksOf(joint)) } : null;
    });
    if (joints.every((joint) => joint === null)) return [];
    return [{ source: "triangulation", label: from.filter((one) => one !== camera).join(", "), place: { camera, frame, hand }, joints }];
  });
}

/**
 * How far a mark is off: from the point that the other views alone make, when there are enough of them. Where one view
 * was set aside, the good ones are not blamed for it: theirs is the distance to the point without it.
 */
export function errorOf(joint: TriangulatedJoint, view: TriangulatedView): number | null {
  const isOneSetAside = joint.views.some((one) => one.residual_px !== null && !one.is_used);
  return isOneSetAside && view.is_used ? view.residual_px : (view.left_out_px ?? view.residual_px);
}

export interface WorstMark {
  readonly joint: number;
  readonly camera: string;
  readonly error: number;
}

/** Every mark that takes part, the one that is farthest off first. */
export const worstMarks = (joints: readonly TriangulatedJoint[]): WorstMark[] =>
  joints
    .flatMap((joint, index) =>
      joint.views.flatMap((view): WorstMark[] => {
        const error = errorOf(joint, view);
        return error === null ? [] : [{ joint: index, camera: view.camera, error }];
      }),
    )
    .sort((a, b) => b.error - a.error);

export type Grade = "good" | "fair" | "bad";

/** Annotators differ by 1.5 px; beyond 5 px two marks are hardly of the same thing. */
export const gradeOf = (error: number): Grade => (error <= 2 ? "good" : error <= 5 ? "fair" : "bad");
