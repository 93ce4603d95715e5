/** Which controls take letters for themselves. A ticked box, a radio or a list that is closed takes none: the page's keys go on working. */

const WITHOUT_TEXT = new Set(["button", "checkbox", "color", "file", "image", "radio", "range", "reset", "submit"]);

/** As much of an element as is asked about here. */
export interface FocusedControl {
  readonly tagName: string;
  readonly isContentEditable: boolean;
  readonly type?: string;
  readonly readOnly?: boolean;
  getAttribute: (name: string) => string | null;
}

export function takesText(control: FocusedControl): boolean {
  if (control.isContentEditable || control.tagName === "TEXTAREA" || control.tagName === "SELECT") return true;
  if (control.tagName !== "INPUT" || WITHOUT_TEXT.has(control.type ?? "text")) return false;
  // A list to choose from that nothing can be typed into has the keys only while it is open.
  return !control.readOnly || control.getAttribute("aria-expanded") === "true";
}

/** What a key may do while one types: it sends, searches or changes the view, but no label, and it hands no work in. */
export const isHarmless = (binding: string): boolean => ["search", "frame.goto", "save.now", "curate.save", "scan.save"].includes(binding) || binding.startsWith("view.");

/** Keys that a focused control needs for itself; the page gets them only on its picture or when nothing has the focus. */
const CONTROL_KEYS = new Set(["Tab", "Shift+Tab", "Space", "Enter", "Left", "Right", "Up", "Down", "Home", "End", "Delete", "Backspace"]);

/** Of these, what a box and a plain button have no use for: after a click on one of them the frames are still walked by arrows. */
const UNUSED_BY_BOX = new Set(["Left", "Right", "Up", "Down", "Home", "End"]);
const UNUSED_BY_BUTTON = new Set(["Left", "Right", "Home", "End"]);

export function keepsKey(control: FocusedControl, chord: string): boolean {
  if (!CONTROL_KEYS.has(chord)) return false;
  if (control.tagName === "INPUT" && control.type === "checkbox") return !UNUSED_BY_BOX.has(chord);
  if (control.tagName === "BUTTON" && control.getAttribute("role") === null) return !UNUSED_BY_BUTTON.has(chord);
  return true;
}
