import { describe, expect, it } from "vitest";
import { isChosen, queryOf, readChoice, writeChoice } from "./evaluations";

describe("the address of an evaluation", () => {
  it("holds the whole choice and gives it back", () => {
    const choice = {
      tracks: ["a", "b"],
      recordings: ["r"],
      project: "p",
      reference: "b",
      snapshots: ["s"],
      camera: "cam 1",
      hand: "left",
      visibility: "occluded",
      sources: ["hand", "import"],
      withoutStart: true,
      within: 7.5,
    };
    expect(readChoice(new URLSearchParams(writeChoice(choice).toString()))).toEqual(choice);
    expect(queryOf(choice)).toBe("track=a&track=b&sequence=r&snapshot=s&project=p&reference=b&camera=cam+1&hand=left&visibility=occluded&source=hand&source=import&without_start=true&within=7.5");
  });

  it("is empty for nothing, and nonsense counts as nothing", () => {
    const nothing = readChoice(new URLSearchParams("within=-3&tracks=,"));
    expect(isChosen(nothing)).toBe(false);
    expect(nothing.within).toBe(10);
    expect(writeChoice(nothing).toString()).toBe("");
  });
});
