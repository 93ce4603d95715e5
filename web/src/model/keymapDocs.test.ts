import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { KEYMAP, type KeyBinding } from "./keymap";

const page = readFileSync(new URL("../../../docs/browser.md", import.meta.url), "utf8");
const written = (key: string): string => `\`${key === "`" ? "Backtick" : key}\``;

test("docs/browser.md lists every key with what it does, and no other", () => {
  const map: readonly KeyBinding[] = KEYMAP;
  const rows = map.map((binding) => `| ${binding.keys.map(written).join(" or ")} | ${binding.label} |`);
  expect(rows.filter((row) => !page.includes(row))).toEqual([]);
  expect(page.split("\n").filter((line) => line.startsWith("| `") && line.split("|").length === 4 && !rows.includes(line))).toEqual(
    page.split("\n").filter((line) => /^\| `(api|model|state|actions|canvas|pages)` \|/.test(line)),
  );
});
