import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "vitest";

const styles = join(import.meta.dirname, "..", "node_modules", "@mantine", "core");
const written = readFileSync(join(import.meta.dirname, "mantine.css"), "utf-8");

/** Names that files take from Mantine's core, as its own files do from each other. */
function namesIn(text: string): string[] {
  return [...text.matchAll(/import\s*\{([^}]*)\}\s*from\s*"@mantine\/core"/g)].flatMap((found) => found[1]!.split(",").map((name) => name.trim().replace(/^type /, "")));
}

const sources = readdirSync(import.meta.dirname, { recursive: true, encoding: "utf-8" }).filter((name) => /\.tsx?$/.test(name));

/** Components of Mantine that one draws with, and so on from there: its files import each other by folder. */
function withParts(names: Iterable<string>): Set<string> {
  const found = new Set<string>();
  const open = [...names];
  for (let name = open.pop(); name !== undefined; name = open.pop()) {
    const folder = join(styles, "esm", "components", name);
    if (found.has(name) || !existsSync(folder)) continue;
    found.add(name);
    for (const file of readdirSync(folder).filter((file) => /\.mjs$/.test(file)))
      open.push(...[...readFileSync(join(folder, file), "utf-8").matchAll(/from "\.\.\/([A-Z]\w+)\//g)].map((match) => match[1]!));
  }
  return found;
}

test("every component that is drawn has its styles", () => {
  const used = withParts(sources.flatMap((name) => namesIn(readFileSync(join(import.meta.dirname, name), "utf-8"))));
  expect(used.size).toBeGreaterThan(40);
  const missing = [...used].filter((name) => existsSync(join(styles, "styles", `${name}.css`)) && !written.includes(`/${name}.css"`));
  expect(missing).toEqual([]);
});
