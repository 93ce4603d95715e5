import { expect, test } from "vitest";
import type { ImportQuestion, SensorFit } from "../api/types";
import { numberFields, optionsKey, stillNeeded, toOptions, withoutField, withSensor } from "./importForm";

const question = (field: string, problem: string): ImportQuestion => ({
  field, label: field, kind: "number", unit: "", ask: "", problem, is_required: problem !== "", proposal: null, proposed_by: "", choices: [],
});
const sensor: SensorFit = { name: "kinect_v2", label: "Kinect v2", source: "", values: { fx: 365, cx: 255, fps: 30 }, is_guess: true };

test("a number that is being typed is no answer yet, and is not lost", () => {
  expect(toOptions({ depth_scale: "0.0", fx: "", cx: 0, fps: 0, name: "a" })).toEqual({ cx: 0, name: "a" });
  expect(toOptions({ depth_scale: "0.001" })).toEqual({ depth_scale: 0.001 });
  expect(toOptions({ fx: "-" })).toEqual({});
});

test("options that mean the same have one text", () => {
  expect(optionsKey({ fx: 1, cx: 2 })).toBe(optionsKey({ cx: 2, fx: 1 }));
  expect(optionsKey({ fx: 1 })).not.toBe(optionsKey({ fx: 2 }));
});

test("a sensor fills its fields and leaves a frame rate that was told", () => {
  expect(withSensor({ fx: 1, fps: 15 }, sensor)).toEqual({ fx: 365, cx: 255, fps: 15, preset: "kinect_v2" });
  expect(withSensor({}, sensor)["fps"]).toBe(30);
});

test("problems that a field mends stand beside it, the others above", () => {
  const questions = [question("fx", "No camera."), question("fps", "")];
  expect(withoutField(["No camera.", "a.png is cut off."], questions)).toEqual(["a.png is cut off."]);
  expect(stillNeeded(questions).map(({ field }) => field)).toEqual(["fx"]);
});

test("videos get no fields of depth cameras", () => {
  expect(numberFields(["world_unit_m", "fps", "hands"]).map(({ name }) => name)).toEqual(["world_unit_m", "fps"]);
});
