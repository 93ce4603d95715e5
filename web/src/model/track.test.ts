import { expect, test } from "vitest";
import type { TrackFrames } from "../api/types";
import { badFrames, nextIn } from "./badFrames";
import { errorColor } from "./errorColor";
import { frameError } from "./frameError";
import { trackRows } from "./trackRows";

const track: TrackFrames = {
  frame: [10, 11, 12, 13],
  status: ["ok", "lost", "recovered", "ok"],
  seconds: [0.1, 0.1, 0.1, 0.1],
  depth_residual_mm: [2, null, 4, 1],
  silhouette_iou: [0.9, null, 0.8, 0.9],
  iterations: [10, 0, 10, 10],
  costs: {}, terms: [],
  stages: {},
  views: [],
};

test("lost frames come first; without any, those with the largest residual", () => {
  expect(badFrames(track)).toEqual([11]);
  expect(badFrames({ ...track, status: ["ok", "ok", "ok", "ok"] })).toEqual([12]);
});

test("in several colour cameras the worst camera's distance from the detector counts", () => {
  const seen = { left_out_px: [1, 1, 1, 1], weight: [1, 1, 1, 1] };
  const views = [
    { camera: "left", fit_px: [3, null, 2, 4], ...seen },
    { camera: "right", fit_px: [5, null, null, 1], ...seen },
  ];
  expect(frameError({ ...track, views })).toMatchObject({ unit: "px", values: [5, null, 2, 4] });
  expect(badFrames({ ...track, views, status: ["ok", "ok", "ok", "ok"] })).toEqual([10]);
  expect(frameError(track)).toMatchObject({ unit: "mm", values: track.depth_residual_mm });
});

test("the way through bad frames goes around", () => {
  expect([nextIn([3, 8], 3, 1), nextIn([3, 8], 8, 1), nextIn([3, 8], 3, -1), nextIn([], 3, 1)]).toEqual([8, 3, 8, undefined]);
});

test("a track that covers a part of the recording stands at its place in the timeline", () => {
  const [error, lost] = trackRows(track, 20);
  const heights = [...(error?.values as Float32Array)].slice(9, 15).map((value) => Math.round(100 * value));
  expect(heights).toEqual([0, 20, 0, 40, 10, 0]);
  expect([...(lost?.values as Float32Array)].indexOf(1)).toBe(11);
});

test("errors go from blue to red and stay within the scale", () => {
  expect([errorColor(-1), errorColor(0), errorColor(1), errorColor(7)]).toEqual([
    "rgb(62 118 208)",
    "rgb(62 118 208)",
    "rgb(214 48 49)",
    "rgb(214 48 49)",
  ]);
});
