import { expect, test } from "vitest";
import { describeSaving, type SaveFacts } from "./saveWords";

const well: SaveFacts = { waiting: 0, isSending: false, isOffline: false, trouble: "", isHeld: false, isKept: true, refusals: 0 };
const nothing = { mine: 0, crops: 0 };
const say = (facts: Partial<SaveFacts>): string => describeSaving({ ...well, ...facts }, nothing, false).text;

test("saved is said when nothing waits anywhere", () => {
  expect(say({})).toBe("saved");
  expect(describeSaving(well, { mine: 2, crops: 0 }, false).text).toBe("saved here, 2 waiting elsewhere");
  expect(describeSaving(well, nothing, true).text).toBe("saving …");
});

test("a change to settle does not hide what waits beside it", () => {
  expect(say({ conflicts: 1, waiting: 1, isOffline: true })).toBe("1 change to settle");
  expect(say({ conflicts: 1, waiting: 3, isOffline: true })).toBe("1 change to settle; offline, 2 waiting");
  expect(say({ conflicts: 2, waiting: 3, isHeld: true })).toBe("2 changes to settle; log in to save, 1 waiting");
  expect(say({ refusals: 1, waiting: 2, isOffline: true })).toBe("not taken by the server, 1 kept here; offline, 1 waiting");
  expect(say({ waiting: 2, isOffline: true })).toBe("offline, 2 waiting");
});
