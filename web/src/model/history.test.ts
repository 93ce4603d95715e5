import { expect, test } from "vitest";
import type { AnnotationRevision } from "../api/types";
import { readHistory } from "./history";

const made = (revision: number, points: number[][] | null): AnnotationRevision =>
  ({ revision, act: "put", points, created_at: "2026-01-02T03:04:05Z", author: revision === 1 ? null : "Ada", operation_id: "" }) as AnnotationRevision;
const empty = Array.from({ length: 21 }, () => [0, 0, 0]);

test("each revision says what it changed, and when it is like an earlier one", () => {
  const first = empty.with(0, [5, 6, 2]);
  const second = first.with(8, [9, 9, 1]);
  const entries = readHistory([made(4, first), made(3, null), made(2, second), made(1, first)]);
  expect(entries.map((entry) => entry.changed)).toEqual([[0], [0, 8], [8], [0]]);
  expect(entries.map((entry) => [entry.isDeleted, entry.sameAs])).toEqual([[false, 1], [true, null], [false, null], [false, null]]);
  expect(entries.map((entry) => entry.author)).toEqual(["Ada", "Ada", "Ada", "somebody"]);
});
