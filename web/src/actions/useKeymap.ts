import { useEffect, useRef } from "react";
import { bindingsFor, chordOf, type Scope } from "../model/keymap";
import { useCurrentKeymap } from "../state/keys";
import { isHarmless, keepsKey, takesText } from "./focusedControl";

export type Handlers = Readonly<Record<string, (event: KeyboardEvent) => void>>;

const isTyping = (target: EventTarget | null): boolean => target instanceof HTMLElement && takesText(target);

function isOnPicture(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement) || target === document.body) return true;
  return target.closest("[data-picture]") !== null && target.closest("[data-over-picture]") === null;
}

/** Answer the keys of a scope. A key without a handler here is left to whoever else listens. */
export const useKeymap = (scope: Scope, handlers: Handlers): void => useKeymapWith(scope, (id) => handlers[id]);

/** As `useKeymap`, where what answers is looked up at each press. */
export function useKeymapWith(scope: Scope, handlerOf: (id: string) => Handlers[string] | undefined): void {
  const current = useRef(handlerOf);
  current.current = handlerOf;
  const map = useCurrentKeymap();
  useEffect(() => {
    const bindings = bindingsFor(scope, map);
    const answer = (event: KeyboardEvent): void => {
      if (event.defaultPrevented || event.isComposing) return;
      const chord = chordOf(event);
      const id = bindings.get(chord)?.id ?? "";
      if (isTyping(event.target) && !(chord.startsWith("Ctrl+") && isHarmless(id))) return;
      if (document.querySelector('[role="dialog"][aria-modal="true"]')) return;
      if (!isOnPicture(event.target) && keepsKey(event.target as HTMLElement, chord)) return;
      const handle = current.current(id);
      if (!handle) return;
      event.preventDefault();
      handle(event);
    };
    window.addEventListener("keydown", answer);
    return () => window.removeEventListener("keydown", answer);
  }, [scope, map]);
}
