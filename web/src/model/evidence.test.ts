import { expect, test } from "vitest";
import type { ViewerSession } from "../api/types";
import { countOf, describeCollisions, describeContacts, describeDetections, describeOrigin, describeUnknown } from "./evidence";

const contacts = { is_of_run: true, fault: null, object: "pipe", is_stable: false, displacement_mm: 36, held_displacement_mm: 36, simulated: 4, parts: [] };
const part = { hand: "right", part: "index distal", distance_mm: 2, is_chosen: false };

test("a frame where nothing is found says so", () => {
  expect(describeDetections({ is_of_run: true, own_detector: null, items: [] })).toContain("No fingertip was found");
  expect(describeCollisions({ is_of_run: true, triangles: 0, vertices: 0, deepest_mm: 0, full_mm: 5, pairs: [] })).toBe("Nothing intersects here.");
  expect(describeContacts({ ...contacts, object: null })).toContain("needs an object and a hand");
  expect(describeContacts({ ...contacts, object: null, fault: "Physics needs pybullet." })).toBe("Physics needs pybullet.");
});

test("an object is held, or falls for want of fingers, or would be held by those chosen", () => {
  expect(describeContacts({ ...contacts, is_stable: true, displacement_mm: 0.82 })).toBe("The pipe is held: simulated, it moves 0.8 mm (less than 3 mm).");
  expect(describeContacts(contacts)).toBe("The pipe falls: no finger part is within 10 mm of it.");
  expect(describeContacts({ ...contacts, displacement_mm: 7, parts: [part] })).toContain("slips by 7.0 mm, and no combination");
  expect(describeContacts({ ...contacts, held_displacement_mm: 0.4, parts: [{ ...part, is_chosen: true }] })).toContain("in contact it moves 0.4 mm");
});

test("a layer of a term that the run did not use is said to be computed now", () => {
  expect(describeOrigin("collisions", false)).toContain("did not use collision (C)");
  expect(describeOrigin("collisions", true)).toBeNull();
  expect(describeOrigin("detections", true, "tips.npz")).toBe("Found by “tips.npz”, at which the run looked in every frame.");
});

test("what was left out is counted, and what cannot be known without colour is said", () => {
  const unknown = { color: "#f06595", pixels: 2400, before: 310, by_color: true };
  expect(describeUnknown(unknown)).toBe("2,400 pixels were left out; 310 of them hide the hand.");
  expect(describeUnknown({ ...unknown, pixels: 0, before: 0 })).toBe("Nothing near the hands was left out here.");
  expect(describeUnknown({ ...unknown, by_color: false })).toContain("Without colour, only things in front of the hand");
});

test("a layer's count is known when it is on", () => {
  const told = { terms: [{ name: "a", count: 620, color: "" }, { name: "b", count: 3000, color: "" }], contacts: { ...contacts, parts: [part] }, collisions: null } as unknown as ViewerSession;
  expect(["correspondences", "contacts", "collisions", "cloud"].map((layer) => countOf(told, layer))).toEqual(["3.6k", "1", null, null]);
  expect(countOf(null, "contacts")).toBeNull();
});
