import { expect, test } from "vitest";
import { mergeMarks } from "./frameMarks";
import { describeFrame, handFrames, progressOf, withSuggested } from "./frameStates";
import { emptyPose, keyText, withJoint } from "./pose";
import type { Suggestion } from "./suggestion";

const key = (frame: number, hand: "right" | "left" = "right") => keyText({ camera: "cam0", frame, hand });
const one = withJoint(emptyPose(), 0, { x: 3, y: 4, v: 2 });

test("every state of a frame has its place and its words", () => {
  const full = emptyPose().map(() => ({ x: 1, y: 1, v: 2 as const }));
  const poses = { [key(1)]: one, [key(2)]: full, [keyText({ camera: "cam1", frame: 3, hand: "right" })]: full };
  const rows = handFrames(poses, new Set([key(2)]), 5, "cam0");
  expect([...(rows[0]?.decided ?? [])].map(progressOf)).toEqual(["none", "partial", "complete", "none", "none"]);
  const proposal: Suggestion = { source: "track", label: "Track 1", place: { camera: "cam0", frame: 1, hand: "right" }, joints: Array.from({ length: 21 }, () => ({ px: [1, 1], guess: "visible" })) };
  const seen = withSuggested(rows, poses, { [key(1)]: { track: proposal }, [key(2)]: { track: proposal } }, new Set(), "cam0");
  expect(seen[0]?.suggested).toEqual(new Set([1]));
  const marks = mergeMarks([{ flagged: new Set([2]) }, { submitted: new Set([2]), flagged: new Set([1]) }]);
  expect(describeFrame(1, seen, marks)).toEqual(["right: 1 of 21, suggested", "left: not marked", "flagged by label QC"]);
  expect(describeFrame(2, seen, marks)).toEqual(["right: complete, key frame", "left: not marked", "flagged by label QC", "submitted"]);
});
