import { expect, test } from "vitest";
import type { Job, JobForm } from "../api/types";
import { compareParams, describeParams } from "./compareJobs";

const job = (params: Record<string, unknown>): Job => ({ params }) as unknown as Job;
const form = { fields: [{ name: "iterations", label: "Iterations" }, { name: "calibrate", label: "Fit the shape" }] } as unknown as JobForm;

test("what differs comes first and is marked, also what only one of them has", () => {
  const rows = compareParams(job({ calibrate: true, iterations: 10 }), job({ calibrate: false, iterations: 10, threads: 2 }), form);
  expect(rows.map((row) => [row.label, row.first, row.second, row.isDifferent])).toEqual([
    ["Fit the shape", "yes", "no", true],
    ["Threads", "–", "2", true],
    ["Iterations", "10", "10", false],
  ]);
});

test("10 and \"10\" are not the same", () => {
  expect(compareParams(job({ a: 10 }), job({ a: "10" }), undefined)[0]?.isDifferent).toBe(true);
});

test("parameters of a training are listed one by one, with names in place of ids", () => {
  const params = { model_id: "7f43", model: "Untrained right hand", job_id: "1", options: { rounds: 3, with_mirrored: true }, test_subjects: ["S32", "S33"] };
  expect(describeParams(params)).toEqual([
    ["Model", "Untrained right hand"],
    ["Job id", "1"],
    ["Test subjects", "S32, S33"],
    ["Rounds of training", "3"],
    ["Left hands, mirrored", "yes"],
  ]);
});

test("a choice is told by its words, and the last frame by what it is", () => {
  const choices = { name: "hand_model_id", label: "Hand model", choices: ["", "7f43"], choice_labels: ["The default hand", "Our hand"] };
  const tracking = { fields: [choices, { name: "last_frame", label: "Last frame" }] } as unknown as JobForm;
  expect(describeParams({ hand_model_id: "7f43", last_frame: -1 }, tracking)).toEqual([
    ["Hand model", "Our hand"],
    ["Last frame", "the recording's last"],
  ]);
  const [hand, last] = compareParams(job({ hand_model_id: "7f43", last_frame: -1 }), job({ hand_model_id: "", last_frame: 4 }), tracking);
  expect([hand?.first, hand?.second, last?.first, last?.second]).toEqual(["Our hand", "The default hand", "the recording's last", "4"]);
});
