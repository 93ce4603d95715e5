import { useEffect, useRef } from "react";
import { bindingsFor, chordOf, type Scope } from "../model/keymap";
import { useCurrentKeymap } from "../state/keys";

export type Handlers = Readonly<Record<string, (event: KeyboardEvent) => void>>;

/** Keys that a focused control needs for itself; the page gets them only on its picture or when nothing has the focus. */
const CONTROL_KEYS = new Set(["Tab", "Shift+Tab", "Space", "Enter", "Left", "Right", "Up", "Down", "Home", "End", "Delete", "Backspace"]);

function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && (target.isContentEditable || ["INPUT", "TEXTAREA", "SELECT"].includes(target.tagName));
}

function isOnPicture(target: EventTarget | null): boolean {
  return !(target instanceof HTMLElement) || target === document.body || target.closest("[data-picture]") !== null;
}

/** Answer the keys of a scope. A key without a handler here is left to whoever else listens. */
export function useKeymap(scope: Scope, handlers: Handlers): void {
  const current = useRef(handlers);
  current.current = handlers;
  const map = useCurrentKeymap();
  useEffect(() => {
    const bindings = bindingsFor(scope, map);
    const answer = (event: KeyboardEvent): void => {
      if (event.defaultPrevented || event.isComposing) return;
      const chord = chordOf(event);
      if (isTyping(event.target) && !(chord.startsWith("Ctrl+") && chord !== "Ctrl+Z" && chord !== "Ctrl+Shift+Z" && chord !== "Ctrl+Y")) return;
      if (document.querySelector('[role="dialog"][aria-modal="true"]')) return;
      if (CONTROL_KEYS.has(chord) && !isOnPicture(event.target)) return;
      const handle = current.current[bindings.get(chord)?.id ?? ""];
      if (!handle) return;
      event.preventDefault();
      handle(event);
    };
    window.addEventListener("keydown", answer);
    return () => window.removeEventListener("keydown", answer);
  }, [scope, map]);
}
