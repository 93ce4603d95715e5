import { expect, test } from "vitest";
import { describeAct, describeDetail } from "./audit";

const ANNA = "8a310fcc-7164-4db7-bf39-e358527d7cd9";
const names = new Map([[ANNA, "Anna"]]);

test("a person is told by name, a range of frames by its ends", () => {
  expect(describeDetail({ given_to: ANNA, frames: [30, 35] }, names)).toBe("given to Anna, frames 30 to 35");
});

test("of ids and hashes the beginning is enough", () => {
  expect(describeDetail({ sequence_id: "66f27aee-c1f9-48a8-a9ab-ff84c0fc820e", sha256: "2ed944b9061f4eb6763c0db6e270e8a3188740eae3fff5b7ed24a9fc228ce104" }, names)).toBe("recording 66f27aee, sha256 2ed944b9061f");
});

test("what is not known is left out, and true is yes", () => {
  expect(describeDetail({ comment_id: ANNA, frame: null, may_write: false, version: 1, jobs: ["a"] }, names)).toBe('comment Anna, may write no, version 1, jobs ["a"]');
});

test("an act is told in words", () => {
  expect([describeAct("project.add_recording"), describeAct("job.start")]).toEqual(["project · add recording", "job · start"]);
});
