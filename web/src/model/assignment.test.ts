import { expect, test } from "vitest";
import type { Assignment, Me, ReplicaSet } from "../api/teams";
import { assignmentAt, lockReason, progressOf } from "./assignment";
import { emptyPose, keyText, type Pose } from "./pose";

const given = (change: Partial<Assignment>): Assignment =>
  ({ id: "a", account_id: "ann", account: "Ann", replica_set_id: null, frame_first: 2, frame_last: 5, state: "open", ...change }) as Assignment;
const me = (id: string, role: Me["role"] = "annotator"): Me => ({ id, name: id, role }) as Me;
const placed: Pose = emptyPose().map((joint, index) => (index === 0 ? { ...joint, x: 1, y: 1, v: 2 as const } : joint));

test("a frame belongs to the range it is in", () => {
  const [first, second] = [given({ id: "1" }), given({ id: "2", frame_first: 6, frame_last: 9 })];
  expect(assignmentAt([first, second], 6)?.id).toBe("2");
  expect(assignmentAt([first, second], 10)).toBeUndefined();
});

test("what the server refuses is locked here too", () => {
  const lock = (assignment: Assignment, who: Me) => lockReason(assignment, who, undefined, "right");
  expect(lock(given({}), me("ann"))).toBeNull();
  expect(lock(given({}), me("bob"))).toContain("Ann");
  expect(lock(given({}), me("rob", "reviewer"))).toBeNull();
  expect(lock(given({ state: "submitted" }), me("ann"))).toContain("review");
  expect(lock(given({ state: "submitted" }), me("rob", "reviewer"))).toBeNull();
  expect(lock(given({ state: "returned" }), me("ann"))).toBeNull();
  expect(lock(given({ state: "accepted" }), me("lea", "lead"))).toContain("finished");
  expect(lock(given({ replica_set_id: "s" }), me("lea", "lead"))).toContain("blind");
  expect(lockReason(given({ replica_set_id: "s" }), me("ann"), { hands: ["right"] } as ReplicaSet, "left")).toContain("not asked");
});

test("a frame is done with a hand, or with every hand in every camera of a replica set", () => {
  const poses = { [keyText({ camera: "cam0", frame: 2, hand: "right" })]: placed, [keyText({ camera: "cam0", frame: 3, hand: "left" })]: emptyPose() };
  expect(progressOf(given({}), undefined, poses)).toEqual({ done: 1, total: 4, next: 3, partial: [2] });
  const replicas = { frames: [2, 5], cameras: ["cam0"], hands: ["right", "left"] } as unknown as ReplicaSet;
  expect(progressOf(given({}), replicas, poses)).toEqual({ done: 0, total: 2, next: 2, partial: [2] });
});
