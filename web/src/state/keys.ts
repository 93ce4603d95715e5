/** The keyboard map as this person wants it: kept in the browser at once, and with the account when it can be reached. */

import { useSyncExternalStore } from "react";
import { fetchPreferences, storePreference } from "../api/preferences";
import { KEYMAP, remapOf, withRemap, type KeyBinding, type Remap } from "../model/keymap";
import { createStore } from "./store";

const NAME = "handloom/keys";
/** Set while the account does not know the newest keys yet. */
const UNSENT = "handloom/keys-unsent";

function read(): Remap {
  try {
    const found: unknown = JSON.parse(window.localStorage.getItem(NAME) ?? "{}");
    return typeof found === "object" && found !== null && !Array.isArray(found) ? (found as Remap) : {};
  } catch {
    return {};
  }
}

function keep(remap: Remap, isUnsent: boolean): void {
  try {
    window.localStorage.setItem(NAME, JSON.stringify(remap));
    if (isUnsent) window.localStorage.setItem(UNSENT, "1");
    else window.localStorage.removeItem(UNSENT);
  } catch {
    // A browser without storage asks the account again next time.
  }
}

const store = createStore<readonly KeyBinding[]>(withRemap(KEYMAP, typeof window === "undefined" ? {} : read()));

export const currentKeymap = store.get;
export const useCurrentKeymap = (): readonly KeyBinding[] => useSyncExternalStore((tell) => store.watch(tell), store.get);

/** First key of an action, for hints beside buttons; "" when it has none. */
export const useKeyOf = (): ((id: string) => string) => {
  const map = useCurrentKeymap();
  return (id) => map.find((binding) => binding.id === id)?.keys[0] ?? "";
};

/** "Next frame (F)" */
export const useHint = (): ((label: string, id: string) => string) => {
  const keyOf = useKeyOf();
  return (label, id) => (keyOf(id) ? `${label} (${keyOf(id)})` : label);
};

let isSending = false;

/** One after the other: of two on their way at once the older could arrive last. */
async function send(): Promise<void> {
  if (isSending) return;
  isSending = true;
  try {
    let sent: Remap;
    do {
      sent = remapOf(store.get());
      await storePreference("keys", sent);
    } while (JSON.stringify(sent) !== JSON.stringify(remapOf(store.get())));
    keep(sent, false);
  } catch {
    // It works here already; the account learns it at the next start.
  } finally {
    isSending = false;
  }
}

/** Give a binding other keys. What it takes from another binding must have been asked before. */
export function bindKeys(id: string, keys: readonly string[]): void {
  change(store.get().map((binding) => (binding.id === id ? { ...binding, keys } : binding)));
}

/** Give a key to one binding and take it from whatever else has it. */
export function moveKey(id: string, key: string, from: string): void {
  change(
    store.get().map((binding) => {
      if (binding.id === id) return { ...binding, keys: [...binding.keys.filter((one) => one !== key), key] };
      return binding.id === from ? { ...binding, keys: binding.keys.filter((one) => one !== key) } : binding;
    }),
  );
}

export const restoreKeys = (): void => change(KEYMAP);

function change(map: readonly KeyBinding[]): void {
  const remap = remapOf(map);
  store.set(withRemap(KEYMAP, remap), "person");
  keep(remap, true);
  void send();
}

/** At the start: the account's keys go before the browser's, except those that it has not been told yet. */
export async function loadKeys(): Promise<void> {
  if (window.localStorage.getItem(UNSENT)) return send();
  const before = store.get();
  try {
    const found = (await fetchPreferences())["keys"];
    if (store.get() !== before) return; // changed meanwhile, and sent
    const remap = typeof found === "object" && found !== null ? (found as Remap) : {};
    keep(remap, false);
    store.set(withRemap(KEYMAP, remap), "server");
  } catch {
    // The browser's own copy holds.
  }
}
