import { expect, test } from "vitest";
import type { Assignment, Me, ReplicaSet } from "../api/teams";
import { assignmentAt, describeUnfinished, lockReason, progressOf, toReview } from "./assignment";
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

const whole: Pose = emptyPose().map((_, index) => ({ x: index - 1, y: -1, v: index === 3 ? 0 : 2 }));

test("a frame is done when every joint asked for is decided, and one that was only begun is told apart", () => {
  const at = (frame: number, hand: "right" | "left"): string => keyText({ camera: "cam0", frame, hand });
  const poses = { [at(2, "right")]: placed, [at(3, "left")]: emptyPose(), [at(4, "right")]: whole, [at(5, "right")]: whole, [at(5, "left")]: placed };
  expect(progressOf(given({}), undefined, poses, ["right"])).toEqual({ done: 1, total: 4, next: 2, partial: [2, 5] });
  expect(progressOf(given({}), undefined, poses, ["right", "left"])).toEqual({ done: 0, total: 4, next: 2, partial: [2, 4, 5] });
  const replicas = { frames: [2, 5], cameras: ["cam0"], hands: ["right", "left"] } as unknown as ReplicaSet;
  expect(progressOf(given({}), replicas, poses, ["right"])).toEqual({ done: 0, total: 2, next: 2, partial: [2, 5] });
  expect(progressOf(given({}), replicas, { ...poses, [at(5, "left")]: whole }, ["right"])).toEqual({ done: 1, total: 2, next: 2, partial: [2] });
  expect(describeUnfinished({ done: 1, total: 4, next: 2, partial: [2, 3] })).toBe("1 frame is not begun. 2 frames have open joints, the first is 2.");
});

test("a reviewer is to review what others submitted, but no set that they mark blindly themselves", () => {
  const submitted = [given({ id: "1", state: "submitted" }), given({ id: "2", state: "submitted", account_id: "rob" }), given({ id: "3", state: "submitted", replica_set_id: "set" })];
  const mine = [given({ id: "4", account_id: "rob", replica_set_id: "set" })];
  const ids = (who: Me, own: Assignment[] = []) => toReview(submitted, own, who).map((one) => one.id);
  expect(ids(me("ann"))).toEqual([]);
  expect(ids(me("rob", "reviewer"))).toEqual(["1", "3"]);
  expect(ids(me("rob", "reviewer"), mine)).toEqual(["1"]);
  expect(ids(me("rob", "lead"), mine)).toEqual(["1", "2"]);
});
