import { expect, test } from "vitest";
import type { FormField, JobForm, Preset } from "../api/types";
import { choosePreset, matchPreset } from "./presets";

const field = (name: string, value: FormField["default"], about: FormField["about"] = "method"): FormField => ({
  name,
  about,
  default: value,
  label: name,
  type: typeof value === "boolean" ? "boolean" : typeof value === "number" ? "integer" : "text",
  help: "",
  choices: null,
  choice_labels: null,
  low: null,
  high: null,
  unit: null,
  is_advanced: false,
});

const preset = (name: string, values: Preset["values"]): Preset => ({ name, label: name, help: "", one_hand_ms: 1, two_hands_and_object_ms: 2, values });

const form: JobForm = {
  kind: "track",
  fields: [field("terms", "LO"), field("iterations", 10), field("calibrate", true), field("first_frame", 0, "recording")],
  presets: [preset("fast", { terms: "LO", iterations: 5 }), preset("balanced", { terms: "LO+SC", iterations: 10 })],
  usual_preset: "balanced",
};
const [fast, balanced] = form.presets as [Preset, Preset];

test("a chosen preset is the one that is found again, and only what differs from the defaults is sent", () => {
  for (const one of form.presets) expect(matchPreset(form, choosePreset(form, {}, one))).toBe(one);
  expect(choosePreset(form, {}, balanced)).toEqual({ terms: "LO+SC" });
});

test("a changed field of the method is one's own, a range of frames is not", () => {
  const changed = choosePreset(form, {}, fast);
  expect(matchPreset(form, { ...changed, first_frame: 7 })).toBe(fast);
  expect(matchPreset(form, { ...changed, iterations: 6 })).toBeNull();
  expect(matchPreset(form, { ...changed, calibrate: false })).toBeNull();
  expect(matchPreset(form, {}), "the defaults themselves are no preset").toBeNull();
});

test("another preset takes one's own method back and leaves the frames", () => {
  expect(choosePreset(form, { terms: "LO+P", calibrate: false, first_frame: 7 }, fast)).toEqual({ iterations: 5, first_frame: 7 });
});
