/** One hand in one image: 21 points in image pixels. Human labels only; predictions have types of their own. */

import type { JointSource, Side, WirePoint } from "../api/types";
import { JOINT_COUNT } from "./joints";

/** As in COCO: 0 absent, 1 occluded, 2 visible. */
export type Visibility = 0 | 1 | 2;

export interface JointPoint {
  /** px, (0, 0) is the centre of the top-left pixel */
  readonly x: number;
  readonly y: number;
  readonly v: Visibility;
  /** What the person accepted instead of placing the joint; left out: placed by hand. */
  readonly from?: JointSource;
}

export type Pose = readonly JointPoint[];

/** `unset`: nobody has looked yet. `outside`: somebody looked, and it is not in the image. */
export type JointStatus = "unset" | "outside" | "occluded" | "visible";

const UNSET: JointPoint = { x: 0, y: 0, v: 0 };
/** Absent by decision: told from unset by its place outside the image, because v = 0 says both in COCO. */
const OUTSIDE: JointPoint = { x: -1, y: -1, v: 0 };

const EMPTY: Pose = Array.from({ length: JOINT_COUNT }, () => UNSET);

/** Always the same one, so that what shows it is not drawn again. */
export const emptyPose = (): Pose => EMPTY;

export function statusOf(point: JointPoint | undefined): JointStatus {
  if (!point) return "unset";
  if (point.v === 2) return "visible";
  if (point.v === 1) return "occluded";
  return point.x === 0 && point.y === 0 ? "unset" : "outside";
}

export const isPlaced = (point: JointPoint | undefined): point is JointPoint => point !== undefined && point.v > 0;

export const placedCount = (pose: Pose | undefined): number => pose?.filter(isPlaced).length ?? 0;

/** Joints that somebody has decided about. */
export const decidedCount = (pose: Pose | undefined): number =>
  pose?.filter((point) => statusOf(point) !== "unset").length ?? 0;

export const isEmpty = (pose: Pose | undefined): boolean => decidedCount(pose) === 0;

/** The joint to do after this one: the next that nobody has decided about, or the same when all are done. */
export function nextOpenJoint(pose: Pose, joint: number): number {
  for (let step = 1; step <= JOINT_COUNT; step += 1) {
    const candidate = (joint + step) % JOINT_COUNT;
    if (statusOf(pose[candidate]) === "unset") return candidate;
  }
  return joint;
}

/** Where marking a hand begins or goes on: its first open joint, or the wrist when all are done. */
export const firstOpenJoint = (pose: Pose | undefined): number => {
  const open = (pose ?? []).findIndex((point) => statusOf(point) === "unset");
  return open < 0 ? 0 : open;
};

export const withJoint = (pose: Pose, joint: number, point: JointPoint): Pose => pose.with(joint, point);

/** The same joint, with another status; a joint that goes outside keeps its place so that it can come back. */
export function withStatus(point: JointPoint, status: JointStatus): JointPoint {
  switch (status) {
    case "unset":
      return UNSET;
    case "outside":
      return statusOf(point) === "unset" ? OUTSIDE : { ...point, v: 0 };
    case "occluded":
      return { ...point, v: 1 };
    case "visible":
      return { ...point, v: 2 };
  }
}

/** Whether an outside joint still knows where it was. */
export const hasPlace = (point: JointPoint): boolean => !(point.x === 0 && point.y === 0) && !(point.x === -1 && point.y === -1);

/** Whether there is something to see of it in the image: a mark, or where a joint was before it went outside. */
export const isShown = (point: JointPoint): boolean => isPlaced(point) || (statusOf(point) === "outside" && hasPlace(point));

export const samePose = (a: Pose | undefined, b: Pose | undefined): boolean =>
  a === b ||
  (a !== undefined &&
    b !== undefined &&
    a.every((point, joint) => {
      const other = b[joint];
      return other !== undefined && point.x === other.x && point.y === other.y && point.v === other.v;
    }));

/** Hundredths of a pixel are finer than any hand or eye. */
const round = (value: number): number => Math.round(value * 100) / 100;

/** A point as it waits to be sent: behind its state where it came from, if not from a hand. */
export type KeptPoint = WirePoint | [...WirePoint, JointSource];

export const toWire = (pose: Pose): WirePoint[] => pose.map(({ x, y, v }) => [round(x), round(y), v]);

export const toKept = (pose: Pose): KeptPoint[] => pose.map(({ x, y, v, from }) => (from ? [round(x), round(y), v, from] : [round(x), round(y), v]));

export const kept = (points: readonly WirePoint[], sources: readonly (JointSource | null)[] | null | undefined): KeptPoint[] =>
  points.map(([x, y, v], joint) => {
    const from = sources?.[joint];
    return from ? [x, y, v, from] : [x, y, v];
  });

export const fromWire = (points: readonly KeptPoint[]): Pose => points.map(([x, y, v, from]) => (from ? { x, y, v, from } : { x, y, v }));

/** Which hand in which image. */
export interface PoseKey {
  readonly camera: string;
  readonly frame: number;
  readonly hand: Side;
}

/** `frame|hand|camera`: the camera's name may hold anything, so it stands last. */
export const keyText = ({ camera, frame, hand }: PoseKey): string => `${frame}|${hand}|${camera}`;

export function parseKey(text: string): PoseKey {
  const [frame = "0", hand = "right", ...camera] = text.split("|");
  return { frame: Number(frame), hand: hand as Side, camera: camera.join("|") };
}
