import { describe, expect, it } from "vitest";
import { axesOf, breaksOf, loneOf } from "./series";

describe("breaksOf", () => {
  it("breaks the line between frames that are not neighbours, also where the frames between them are not listed", () => {
    expect(breaksOf([0, 1, 2, 42, 43], [1, 2, 3, 4, 5])).toEqual([[2, 3]]);
    expect(breaksOf([0, 40, 80], [1, 2, 3])).toEqual([
      [0, 1],
      [1, 2],
    ]);
  });

  it("breaks it over frames without a value", () => {
    expect(breaksOf([0, 1, 2, 3], [1, null, null, 4])).toEqual([[0, 3]]);
  });

  it("leaves neighbours joined", () => {
    expect(breaksOf([5, 6, 7], [1, 2, 3])).toEqual([]);
    expect(breaksOf([], [])).toEqual([]);
  });
});

describe("loneOf", () => {
  it("finds the values that no line shows", () => {
    expect(loneOf([0, 1, 40, 80, 81], [1, 2, 3, 4, null])).toEqual([2, 3]);
    expect(loneOf([7], [1])).toEqual([0]);
    expect(loneOf([0, 1, 2], [1, null, 3])).toEqual([0, 2]);
    expect(loneOf([0, 1, 2], [1, 2, 3])).toEqual([]);
  });
});

describe("axesOf", () => {
  it("gives each quantity its own axis, the first one on the left", () => {
    expect(axesOf([{ axis: "Depth residual, mm", unit: "mm" }, { axis: "Annotated error, px", unit: "px" }, { axis: "Depth residual, mm", unit: "mm" }])).toEqual([
      "Depth residual, mm",
      "Annotated error, px",
    ]);
  });

  it("refuses two units on one axis, and a third axis", () => {
    expect(() => axesOf([{ axis: "Error", unit: "mm" }, { axis: "Error", unit: "px" }])).toThrow("give each unit its own axis");
    expect(() => axesOf(["a", "b", "c"].map((axis) => ({ axis, unit: axis })))).toThrow("two axes, not 3");
  });
});
