/** A page of ours inside the page has its own keyboard; what this page answers is taken from it, the rest stays there. */

import { takesText, type FocusedControl } from "./focusedControl";

/** Keys pressed in the inner page go to this page first, and to the inner one only when nothing here answers them. */
export function shareKeys(inner: Window): void {
  const share = (event: KeyboardEvent): void => {
    // Elements of the inner page are of its own classes: `instanceof` knows none of them.
    const target = event.target as Partial<FocusedControl> | null;
    if (target?.tagName && takesText(target as FocusedControl)) return;
    const again = new KeyboardEvent(event.type, event);
    window.dispatchEvent(again);
    if (!again.defaultPrevented) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  inner.addEventListener("keydown", share, true);
  inner.addEventListener("keyup", share, true);
}
