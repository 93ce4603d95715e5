import { expect, test } from "vitest";
import type { HandToLookAt } from "../api/types";
import { describeShown, findMeant, isDoubtful } from "./lookAt";

const doubt = { kind: "fit" as const, score: 2, reason: "The fit is 14 px from what the detector saw in cam1.", camera: "cam1", joints: [8], flag: null };
const item: HandToLookAt = { frame: 3, hand: "left", score: 2, doubts: [doubt], camera: "cam1", points: [], shows: "track" };

test("joints are ringed in the camera that the worst doubt is about, and in every one if it is about all", () => {
  expect(findMeant(item)).toEqual([8]);
  expect(findMeant({ ...item, camera: "cam0" })).toEqual([]);
  expect(findMeant({ ...item, camera: "cam0", doubts: [{ ...doubt, camera: null }] })).toEqual([8]);
});

test("a hand is doubtful from a score of 1 on", () => {
  expect([isDoubtful(item), isDoubtful({ ...item, score: 1 }), isDoubtful({ ...item, score: 0.999 })]).toEqual([true, true, false]);
});

test("a picture says whose joints it shows", () => {
  expect(describeShown(item)).toBe("Not labelled here: the track is shown.");
  expect(describeShown({ ...item, shows: "label" })).toBe("The label is shown.");
});
