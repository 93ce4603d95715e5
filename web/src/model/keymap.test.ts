import { expect, test } from "vitest";
import { bindingsFor, chordOf, faultOf, findConflicts, KEYMAP, remapOf, RESERVED, withRemap, type KeyBinding } from "./keymap";

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
  expect(keys.get("End"), "of the track page only").toBeUndefined();
});

test("a person's keys go before the defaults, never meet them, and only they are kept", () => {
  const mine = withRemap(map, { "frame.next": ["X", "Ctrl+T"], nothing: ["Y"], "frame.back": "Z" as unknown as string[] });
  expect(findConflicts(mine)).toEqual([]);
  expect(bindingsFor("annotate", mine).get("X")?.id).toBe("frame.next");
  expect(bindingsFor("annotate", mine).get("F")).toBeUndefined();
  expect(bindingsFor("annotate", mine).get("Delete")?.id).toBe("joint.clear");
  expect(remapOf(withRemap(map, remapOf(mine)))).toEqual(remapOf(mine));
  expect(remapOf(map)).toEqual({});
});

test("a key that is taken, reserved or no key at all is refused with the reason", () => {
  expect(faultOf(map, "frame.next", "Q")).toMatchObject({ kind: "taken", by: { id: "joint.occluded" } });
  expect(faultOf(map, "frame.next", "F1")).toMatchObject({ kind: "taken", by: { id: "help" } });
  expect(faultOf(map, "frame.next", "Alt+F9")).toBeNull();
  expect(faultOf(map, "frame.next", "Ctrl+W")).toEqual({ kind: "reserved" });
  expect(faultOf(map, "frame.next", "Alt+Alt")).toEqual({ kind: "modifier" });
});
