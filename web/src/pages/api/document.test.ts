import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { describeSchema, groupOperations, schemaName, type ApiDocument } from "./document";

const document = JSON.parse(readFileSync("src/api/openapi.json", "utf-8")) as ApiDocument;

test("every request of the document is on the page, once", () => {
  const shown = groupOperations(document, "").flatMap(([, operations]) => operations);
  expect(shown).toHaveLength(Object.values(document.paths).flatMap((item) => Object.keys(item)).length);
  expect(new Set(shown.map(({ method, path }) => `${method} ${path}`)).size).toBe(shown.length);
});

test("words narrow the list, whatever their order and case", () => {
  const found = groupOperations(document, "skeleton GET").flatMap(([, operations]) => operations);
  expect(found.map(({ path }) => path)).toEqual(["/api/v1/hand-skeleton"]);
  expect(groupOperations(document, "no such thing at all")).toEqual([]);
});

test("a schema is said in few words", () => {
  expect(describeSchema({ type: "array", items: { $ref: "#/components/schemas/Scan" } })).toBe("list of Scan");
  expect(describeSchema({ anyOf: [{ enum: ["right", "left"] }, { type: "null" }] })).toBe('"right" | "left" | null');
  expect(schemaName({ items: { $ref: "#/components/schemas/Scan" } })).toBe("Scan");
  expect(schemaName(undefined)).toBeNull();
});
