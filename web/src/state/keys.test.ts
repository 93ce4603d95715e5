import { beforeEach, expect, test, vi } from "vitest";
import { remapOf, type Remap } from "../model/keymap";

/** An account that answers when it is told to: what is read is as it was when it was asked, a change is made when it is answered. */
const account = {
  preferences: { keys: {} as Remap },
  waiting: [] as { answer: () => void; refuse: () => void }[],
  mostAtOnce: 0,
};

vi.stubGlobal("fetch", (_: string, { method, body }: { method: string; body: string | null }) => {
  const before = account.preferences;
  const asked = new Promise<Response>((resolve, reject) => {
    const answer = () => {
      if (method === "PUT") account.preferences = JSON.parse(body ?? "") as typeof account.preferences;
      const preferences = method === "PUT" ? account.preferences : before;
      resolve(new Response(JSON.stringify({ preferences }), { headers: { ETag: "1" } }));
    };
    account.waiting.push({ answer, refuse: () => reject(new TypeError("Failed to fetch")) });
  });
  account.mostAtOnce = Math.max(account.mostAtOnce, account.waiting.length);
  return asked;
});

/** Until nothing is asked any more: the newest request first, so that of two under way at once the older arrives last. */
async function answerAll(): Promise<void> {
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve));
    const newest = account.waiting.pop();
    if (!newest) return;
    newest.answer();
  }
}

let kept: Map<string, string>;

async function start() {
  vi.resetModules();
  return import("./keys");
}

beforeEach(() => {
  kept = new Map();
  const localStorage = { getItem: (name: string) => kept.get(name) ?? null, setItem: (name: string, value: string) => kept.set(name, value), removeItem: (name: string) => kept.delete(name) };
  vi.stubGlobal("window", { localStorage });
  Object.assign(account, { preferences: { keys: {} }, waiting: [], mostAtOnce: 0 });
});

const [first, second] = ["search", "settings"];

test("keys changed while a change is on its way follow it, one request at a time, and the account has the newest", async () => {
  const keys = await start();
  keys.bindKeys(first, ["Alt+7"]);
  await new Promise((resolve) => setTimeout(resolve));
  keys.bindKeys(first, ["Alt+8"]);
  keys.bindKeys(second, ["Alt+9"]);
  await answerAll();
  expect(account.preferences.keys).toEqual({ [first]: ["Alt+8"], [second]: ["Alt+9"] });
  expect(account.mostAtOnce).toBe(1);
  expect(kept.has("handloom/keys-unsent")).toBe(false);
});

test("keys that did not arrive are sent at the next start instead of the account's", async () => {
  const keys = await start();
  keys.bindKeys(first, ["Alt+8"]);
  account.waiting.pop()?.refuse();
  await answerAll();
  expect(account.preferences.keys).toEqual({});
  const again = await start();
  void again.loadKeys();
  await answerAll();
  expect(account.preferences.keys).toEqual({ [first]: ["Alt+8"] });
  expect(remapOf(again.currentKeymap())).toEqual({ [first]: ["Alt+8"] });
});

test("keys changed while the account's are loaded stay", async () => {
  account.preferences = { keys: { [first]: ["Alt+7"] } };
  const keys = await start();
  void keys.loadKeys();
  keys.bindKeys(first, ["Alt+8"]);
  const [load] = account.waiting.splice(0, 1);
  await answerAll();
  expect(account.preferences.keys).toEqual({ [first]: ["Alt+8"] });
  load?.answer();
  await answerAll();
  expect(remapOf(keys.currentKeymap())).toEqual({ [first]: ["Alt+8"] });
});
