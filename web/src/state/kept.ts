/** A store that this browser keeps, shared by its tabs: what is a matter of the person and the screen. */

import { createStore, type Store } from "./store";

/** What is stored under a name; undefined when there is nothing, or nothing that can be read. */
export function readKept(name: string): unknown {
  try {
    return JSON.parse(window.localStorage.getItem(name) ?? "null") ?? undefined;
  } catch {
    return undefined;
  }
}

export function keep(name: string, value: unknown): void {
  try {
    window.localStorage.setItem(name, JSON.stringify(value));
  } catch {
    // A browser without storage forgets it with the page.
  }
}

/** `parse` makes a value of whatever was stored, also by an older version of the app. */
export function createKept<S>(name: string, parse: (found: unknown) => S): Store<S> {
  const store = createStore<S>(parse(readKept(name)));
  store.watch((now, _, origin) => origin === "person" && keep(name, now));
  window.addEventListener("storage", (event) => event.key === name && store.set(parse(readKept(name)), "server"));
  return store;
}
