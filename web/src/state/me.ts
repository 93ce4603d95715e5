/** Whose page this is, and whether they are still logged in. */

import { useSyncExternalStore } from "react";
import { fetchMe } from "../api/account";
import { ApiError, setDoorkeeper } from "../api/client";
import type { Me, Role } from "../api/types";
import { createStore } from "./store";

export type Presence =
  | { readonly kind: "asking" }
  | { readonly kind: "away"; readonly failure: Error }
  /** Nobody is logged in and nothing is open. */
  | { readonly kind: "out" }
  | { readonly kind: "in"; readonly me: Me }
  /** Pages are open, but the login has ended or is somebody else's by now. */
  | { readonly kind: "expired"; readonly me: Me; readonly isOther: boolean };

const store = createStore<Presence>({ kind: "asking" });
let loginCount = 0;
const waiting = new Set<() => void>();

export const usePresence = (): Presence => useSyncExternalStore((tell) => store.watch(tell), store.get);

const mine = (): Me | null => {
  const now = store.get();
  return now.kind === "in" || now.kind === "expired" ? now.me : null;
};

/** The person of this page. Pages are shown only when it is known. */
export function useMe(): Me {
  const presence = usePresence();
  if (presence.kind !== "in" && presence.kind !== "expired") throw new Error("nobody is logged in");
  return presence.me;
}

export function accountId(): string {
  const me = mine();
  if (!me) throw new Error("nobody is logged in");
  return me.id;
}

const ROLES: readonly Role[] = ["annotator", "reviewer", "lead", "admin"];

export const hasRole = (me: Me, role: Role): boolean => ROLES.indexOf(me.role) >= ROLES.indexOf(role);

setDoorkeeper({
  account: () => mine()?.id ?? null,
  loginCount: () => loginCount,
  report(failure: ApiError) {
    const me = mine();
    const isOther = failure.error === "OtherAccountError";
    if (me) store.set({ kind: "expired", me, isOther }, "server");
    else if (store.get().kind !== "out") store.set({ kind: "out" }, "server");
  },
  wait(signal) {
    return new Promise((resolve, reject) => {
      const go = (): void => {
        waiting.delete(go);
        resolve();
      };
      waiting.add(go);
      signal?.addEventListener("abort", () => {
        waiting.delete(go);
        reject(signal.reason as Error);
      });
    });
  },
});

/** Names of what this browser keeps for the person before, and must not hand to the next. */
const PERSONAL = ["handloom/keys", "handloom/keys-unsent", "handloom/last-annotated"];

const NAMES = "handloom/names";

const knownNames = (): Record<string, string> => {
  try {
    return JSON.parse(window.localStorage.getItem(NAMES) ?? "{}") as Record<string, string>;
  } catch {
    return {};
  }
};

/** The name of somebody who has used this browser. */
export const nameOf = (account: string): string => knownNames()[account] ?? "somebody else";

function keepName({ id, name }: Me): void {
  try {
    window.localStorage.setItem(NAMES, JSON.stringify({ ...knownNames(), [id]: name }));
  } catch {
    // A browser without storage keeps nothing of anybody either.
  }
}

/** Somebody has logged in. Another person gets fresh pages; what the first one left unsaved waits for them here. */
export function welcome(me: Me): void {
  const before = mine();
  const last = window.localStorage.getItem(LAST);
  if (last !== null && last !== me.id) PERSONAL.forEach((name) => window.localStorage.removeItem(name));
  window.localStorage.setItem(LAST, me.id);
  keepName(me);
  if (before && before.id !== me.id) {
    window.location.reload();
    return;
  }
  loginCount += 1;
  store.set({ kind: "in", me }, "server");
  [...waiting].forEach((go) => go());
}

const LAST = "handloom/account";

/** Ask the server who this is; again and again while it is away. */
export async function askWhoIAm(): Promise<void> {
  try {
    welcome(await fetchMe());
  } catch (failure) {
    if (failure instanceof ApiError && failure.status === 401) return;
    store.set({ kind: "away", failure: failure as Error }, "server");
    setTimeout(() => void askWhoIAm(), 2000);
  }
}
