/** What stands in a line of the audit trail beside who, when and what. */

const ID = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/i;
const HASH = /^[0-9a-f]{64}$/i;

function describeValue(value: unknown, names: ReadonlyMap<string, string>): string {
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "string") return names.get(value) ?? (ID.test(value) ? value.slice(0, 8) : HASH.test(value) ? value.slice(0, 12) : value);
  return typeof value === "number" ? String(value) : JSON.stringify(value);
}

/** "project · add recording". */
export const describeAct = (act: string): string => act.replace(".", " · ").replaceAll("_", " ");

/** "given to Anna, frames 0 to 9": people by their names, ids and hashes by their beginnings; what is not known is left out. */
export function describeDetail(detail: Readonly<Record<string, unknown>>, names: ReadonlyMap<string, string>): string {
  return Object.entries(detail)
    .filter(([, value]) => value !== null)
    .map(([name, value]) => {
      const isRange = name === "frames" && Array.isArray(value) && value.length === 2;
      return `${name.replaceAll("_", " ").replace(/ id$/, "").replace(/^sequence$/, "recording")} ${isRange ? value.join(" to ") : describeValue(value, names)}`;
    })
    .join(", ");
}
