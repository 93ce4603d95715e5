import { expect, test } from "vitest";
import { formatAgo, formatBytes, formatDuration, formatFileFormat, formatLeft, formatMeasure, formatName, formatNumber, formatPicture, formatRough } from "./format";

test("durations are short for seconds and plain for hours", () => {
  expect([0.27, 9.99, 65, 3725].map(formatDuration)).toEqual(["0.3 s", "0:10", "1:05", "1 h 02 min"]);
});

test("what is left is never nothing while it lasts", () => {
  expect([0, 0.4, 5.4, 65].map(formatLeft)).toEqual(["almost done", "almost done", "5.4 s left", "1:05 left"]);
});

test("times are told as people would", () => {
  const now = Date.parse("2026-01-10T12:00:00Z");
  expect(["2026-01-10T11:59:40Z", "2026-01-10T11:58:00Z", "2026-01-10T09:00:00Z", "2026-01-09T10:00:00Z"].map((time) => formatAgo(time, now))).toEqual([
    "just now",
    "2 minutes ago",
    "3 hours ago",
    "yesterday",
  ]);
});

test("what is not known is a dash, never NaN", () => {
  expect([formatNumber(null), formatNumber(undefined), formatNumber(Number.NaN), formatNumber(2.345, 2)]).toEqual(["–", "–", "–", "2.35"]);
});

test("a unit stands only beside a number", () => {
  expect([formatMeasure(null, "px"), formatMeasure(Number.NaN, "mm"), formatMeasure(0, "px"), formatMeasure(2.345, "mm", 2)]).toEqual(["–", "–", "0.0 px", "2.35 mm"]);
});

test("names of fields become words", () => {
  expect([formatName("depth_residual_mm"), formatBytes(1234567), formatBytes(12)]).toEqual(["Depth residual mm", "1.2 MB", "12 B"]);
});

test("a number of any size is written out", () => {
  expect([0.034217, 20.06, 2486.3, 12345678].map(formatRough)).toEqual(["0.0342", "20.1", "2,490", "12,300,000"]);
});

test("what files were read as, and a film's pictures, are told in words", () => {
  expect([formatFileFormat("synced_videos"), formatFileFormat("rgbd_folder"), formatFileFormat("what_comes_next")]).toEqual(["synchronised videos", "RGB-D images in a folder", "what comes next"]);
  expect([formatPicture("a/film.mp4#189"), formatPicture("depth/depth_100.png"), formatPicture("odd#name.png")]).toEqual(["Frame 189 of film.mp4", "depth_100.png", "odd#name.png"]);
});
