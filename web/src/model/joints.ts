/** The 21 joints of a hand in the order of every file and request, and how they are drawn. */

import type { Side } from "../api/types";

export const FINGERS = ["thumb", "index", "middle", "ring", "little"] as const;
export type Finger = (typeof FINGERS)[number];

export const WRIST = 0;
export const JOINT_COUNT = 21;

const PHALANXES: Record<Finger, readonly string[]> = {
  thumb: ["cmc", "mcp", "ip", "tip"],
  index: ["mcp", "pip", "dip", "tip"],
  middle: ["mcp", "pip", "dip", "tip"],
  ring: ["mcp", "pip", "dip", "tip"],
  little: ["mcp", "pip", "dip", "tip"],
};

export const JOINTS: readonly string[] = [
  "wrist",
  ...FINGERS.flatMap((finger) => PHALANXES[finger].map((part) => `${finger}_${part}`)),
];

/** Pairs of joints with a line between them: wrist to the base of a finger, then along it. */
export const EDGES: readonly (readonly [number, number])[] = FINGERS.flatMap((_, finger) => {
  const base = 1 + 4 * finger;
  return [[WRIST, base], [base, base + 1], [base + 1, base + 2], [base + 2, base + 3]] as const;
});

/** Index into FINGERS, or -1 for the wrist. */
export const fingerOf = (joint: number): number => (joint === WRIST ? -1 : Math.floor((joint - 1) / 4));

export const jointsOfFinger = (finger: number): number[] => [0, 1, 2, 3].map((k) => 1 + 4 * finger + k);

/** "index pip" for people. */
export const jointLabel = (joint: number): string => (JOINTS[joint] ?? "?").replace("_", " ");

/** Only the part within its finger: "PIP". */
export const partLabel = (joint: number): string => {
  const name = JOINTS[joint] ?? "?";
  const part = name.slice(name.indexOf("_") + 1);
  return part === "tip" || part === "wrist" ? part : part.toUpperCase();
};

/** The same hues as in the 3D viewer (server/viewer/layers.py). */
export const FINGER_COLORS = ["#fa5252", "#fcc419", "#51cf66", "#22b8cf", "#cc5de8"] as const;
export const WRIST_COLOR = "#ced4da";

export const jointColor = (joint: number): string => FINGER_COLORS[fingerOf(joint)] ?? WRIST_COLOR;

export const HANDS: readonly Side[] = ["right", "left"];
export const otherHand = (hand: Side): Side => (hand === "right" ? "left" : "right");

/** Right is orange and round, left is blue and square, everywhere. */
export const HAND_COLORS: Record<Side, string> = { right: "#f08c00", left: "#3384f0" };
export const OBJECT_COLOR = "#40b05c";
