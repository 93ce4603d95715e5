import { expect, test } from "vitest";
import { KEYMAP, type KeyBinding } from "./keymap";

const written = (key: string): string => `\`${key === "`" ? "Backtick" : key}\``;
const row = (binding: KeyBinding): string => `| ${binding.keys.map(written).join(" or ")} | ${binding.label} |`;

/** Every key with what it does, in the order of the map. */
function writePage(map: readonly KeyBinding[]): string {
  const groups = [...new Set(map.map((binding) => binding.group))];
  const parts = groups.map((group) => `## ${group}\n\n| key | does |\n|---|---|\n${map.filter((one) => one.group === group).map(row).join("\n")}\n`);
  return `# Keys\n\n    cd web && npx vitest run keymapDocs --update\n\n${parts.join("\n")}`;
}

test("keymap.md lists every key with what it does, and no other", async () => {
  await expect(writePage(KEYMAP)).toMatchFileSnapshot("keymap.md");
});
