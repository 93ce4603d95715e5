import { expect, it } from "vitest";
import type { JointSource } from "../api/types";
import { copyOf } from "../actions/annotate/bring";
import { interpolate } from "./interpolation";
import { emptyPose, type JointPoint } from "./pose";
import { describeLeftOut, isIndependent, ofIndependent } from "./source";

const point = (from?: JointSource): JointPoint => ({ x: 5, y: 5, v: 2, ...(from ? { from } : {}) });
const track: JointSource = { kind: "track", label: "Track 1" };

it("what is made of a track's joints never counts as free of it, however often it is copied", () => {
  const pose = emptyPose().with(0, point()).with(1, point(track)).with(2, point({ kind: "import" }));
  const twice = copyOf(copyOf(pose, 1), 2);
  expect(twice.slice(0, 3).map(({ from }) => isIndependent(from))).toEqual([true, false, true]);
  const between = interpolate(pose, emptyPose().with(0, point()).with(1, point()).with(2, point({ kind: "fit" })), 0.5);
  expect(between.slice(0, 3).map((joint) => joint?.is_independent)).toEqual([true, undefined, undefined]);
  expect(isIndependent({ kind: "detector", label: "Hand detector" })).toBe(false);
  expect([ofIndependent(), ofIndependent(point(), point({ kind: "copy", label: "frame 3" }))]).toEqual([{}, {}]);
});

it("says how many joints are left out, and why", () => {
  const counted = { origin: "hand", words: "placed by hand", joints: 20, is_counted: true };
  expect(describeLeftOut([counted])).toBe("");
  expect(describeLeftOut([counted, { origin: "track", words: "accepted from Track 1", joints: 42, is_counted: false }])).toBe("42 joints are left out: 42 accepted from Track 1.");
});
