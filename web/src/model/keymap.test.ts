import { expect, test } from "vitest";
import { bindingsFor, chordOf, findConflicts, KEYMAP, RESERVED, type KeyBinding } from "./keymap";

const press = (key: string, modifiers: Partial<Record<"ctrlKey" | "metaKey" | "altKey" | "shiftKey", boolean>> = {}) => ({
  key,
  ctrlKey: false,
  metaKey: false,
  altKey: false,
  shiftKey: false,
  ...modifiers,
});
const map: readonly KeyBinding[] = KEYMAP;

test("no key means two things on one page", () => {
  expect(findConflicts(map)).toEqual([]);
});

test("the conflict check does find a conflict", () => {
  const twice = { ...map[0]!, id: "other", scope: "annotate" as const };
  expect(findConflicts([map[0]!, twice])).toHaveLength(1);
});

test("no key belongs to the browser", () => {
  expect(map.flatMap((binding) => binding.keys).filter((key) => RESERVED.includes(key))).toEqual([]);
});

test("ids are unique and every binding says what it does", () => {
  expect(new Set(map.map((binding) => binding.id)).size).toBe(map.length);
  expect(map.every((binding) => binding.label.length > 2 && binding.keys.length > 0)).toBe(true);
});

test("key presses are written as in the table", () => {
  expect(chordOf(press("f"))).toBe("F");
  expect(chordOf(press("Z", { ctrlKey: true, shiftKey: true }))).toBe("Ctrl+Shift+Z");
  expect(chordOf(press("z", { metaKey: true }))).toBe("Ctrl+Z");
  expect(chordOf(press("?", { shiftKey: true }))).toBe("?");
  expect(chordOf(press("ArrowRight", { shiftKey: true }))).toBe("Shift+Right");
  expect(chordOf(press(" "))).toBe("Space");
  expect(chordOf(press("Tab", { shiftKey: true }))).toBe("Shift+Tab");
});

test("a page sees its own keys and those of everywhere", () => {
  const keys = bindingsFor("annotate");
  expect(keys.get("F")?.id).toBe("frame.next");
  expect(keys.get("Ctrl+K")?.id).toBe("search");
  expect(keys.get("M")).toBeUndefined();
});
