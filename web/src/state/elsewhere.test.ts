import { expect, test, vi } from "vitest";

class MemoryStorage implements Storage {
  private readonly items = new Map<string, string>();
  get length() {
    return this.items.size;
  }
  key = (at: number) => [...this.items.keys()][at] ?? null;
  getItem = (name: string) => this.items.get(name) ?? null;
  setItem = (name: string, value: string) => void this.items.set(name, value);
  removeItem = (name: string) => void this.items.delete(name);
  clear = () => this.items.clear();
}

const local = new MemoryStorage();
vi.stubGlobal("window", { localStorage: local, sessionStorage: new MemoryStorage(), addEventListener: () => undefined });
const { findElsewhere } = await import("./elsewhere");
const { createJournal } = await import("./journal");
const { createSaveQueue } = await import("./saveQueue");

const save = { operationId: "1", points: [], base: null };
const never = () => new Promise<never>(() => undefined);

test("what waits in other recordings, in other tabs, of other people and for other pages is counted apart", () => {
  const session = new MemoryStorage();
  local.setItem("handloom/names", JSON.stringify({ ben: "Ben" }));
  createJournal(local, "anna", "here").keep("1|right|cam0", [save]);
  createJournal(local, "anna", "here+keys").keep("1|right|cam0", [save]);
  const queues = new Map(["here", "here+keys"].map((scope) => [scope, createSaveQueue(never, createJournal(local, "anna", scope))]));
  const find = (own: { scope: string } | "decisions" = { scope: "here" }) => findElsewhere({ local, session }, "anna", queues, own);
  expect(find(), "the page counts these itself").toEqual({ mine: 0, recording: null, crops: 0, others: [] });

  createJournal(local, "anna", "here").keep("2|right|cam0", [save]);
  expect(find(), "made in another tab").toMatchObject({ mine: 1, recording: "here" });
  local.removeItem("handloom/unsaved/anna/here/2|right|cam0");

  createJournal(local, "anna", "there~replica").keep("2|right|cam0", [save]);
  local.setItem("handloom/decisions/anna/000000000000001-op", "{}");
  createJournal(local, "ben", "here").keep("1|left|cam0", [save]);
  session.setItem("handloom/crop/anna/scan", "{}");
  session.setItem("handloom/crop/anna/opened", "null");
  session.setItem("handloom/crop/ben/scan", "{}");
  expect(find(), "a scan that was only opened is no crop").toEqual({ mine: 2, recording: "there", crops: 1, others: [{ name: "Ben", count: 1 }] });
  expect(find("decisions"), "on the page of decisions the gestures are elsewhere").toMatchObject({ mine: 3 });
});
