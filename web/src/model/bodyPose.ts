/** Poses of the body made with a few sliders. */

import type { BodyFrame } from "../api/bodies";

type Vector = readonly [number, number, number];

/** A slider that bends the same joint of both sides. */
export interface BodySlider {
  readonly key: string;
  readonly label: string;
  readonly least: number;
  readonly most: number;
  /** Rotation vectors by joint for one degree, in degrees; arms lie along x, y is up, the face looks along z. */
  readonly turns: Readonly<Record<string, Vector>>;
}

export const BODY_SLIDERS: readonly BodySlider[] = [
  { key: "arms_down", label: "Arms lowered", least: -60, most: 85, turns: { left_shoulder: [0, 0, -1], right_shoulder: [0, 0, 1] } },
  { key: "arms_forward", label: "Arms forward", least: -30, most: 90, turns: { left_collar: [0, -0.2, 0], right_collar: [0, 0.2, 0], left_shoulder: [0, -0.8, 0], right_shoulder: [0, 0.8, 0] } },
  { key: "elbows", label: "Elbows bent", least: 0, most: 140, turns: { left_elbow: [0, -1, 0], right_elbow: [0, 1, 0] } },
  { key: "forearms", label: "Forearms turned", least: -80, most: 80, turns: { left_wrist: [1, 0, 0], right_wrist: [1, 0, 0] } },
  { key: "wrists", label: "Wrists bent", least: -60, most: 70, turns: { left_wrist: [0, 0, -1], right_wrist: [0, 0, 1] } },
  { key: "hips", label: "Hips bent", least: 0, most: 100, turns: { left_hip: [-1, 0, 0], right_hip: [-1, 0, 0] } },
  { key: "knees", label: "Knees bent", least: 0, most: 130, turns: { left_knee: [1, 0, 0], right_knee: [1, 0, 0] } },
  { key: "back", label: "Back bent", least: -30, most: 60, turns: { spine1: [0.34, 0, 0], spine2: [0.33, 0, 0], spine3: [0.33, 0, 0] } },
  { key: "head", label: "Head turned", least: -70, most: 70, turns: { neck: [0, 0.5, 0], head: [0, 0.5, 0] } },
];

/** So many components of each hand have a slider: [R17] uses six of them for bodies. */
export const HAND_SLIDERS = 6;

export interface BodySetting {
  /** Degrees by slider. */
  readonly angles: Readonly<Record<string, number>>;
  readonly left: readonly number[];
  readonly right: readonly number[];
}

export const AT_REST: BodySetting = { angles: {}, left: [], right: [] };

/** A setting as the server poses it. Several sliders of one joint add up, as rotation vectors do while they are small. */
export function frameOfSetting({ angles, left, right }: BodySetting): BodyFrame {
  const joints: Record<string, number[]> = {};
  for (const { key, turns } of BODY_SLIDERS) {
    const degrees = angles[key] ?? 0;
    if (degrees === 0) continue;
    for (const [joint, turn] of Object.entries(turns)) {
      const before = joints[joint] ?? [0, 0, 0];
      joints[joint] = before.map((value, axis) => value + (degrees * (turn[axis] as number) * Math.PI) / 180);
    }
  }
  return { pose: null, joints, hands: { left: [...left], right: [...right] }, translation: [0, 0, 0] };
}
