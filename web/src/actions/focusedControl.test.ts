import { describe, expect, it } from "vitest";
import { isHarmless, keepsKey, takesText, type FocusedControl } from "./focusedControl";

const control = (tagName: string, rest: Partial<FocusedControl> & { expanded?: string } = {}): FocusedControl => ({
  tagName,
  isContentEditable: false,
  getAttribute: (name) => (name === "aria-expanded" ? (rest.expanded ?? null) : null),
  ...rest,
});

describe("takesText", () => {
  it("says yes for what one types into", () => {
    for (const type of ["text", "search", "number", "password", "email", "date"]) expect(takesText(control("INPUT", { type }))).toBe(true);
    expect(takesText(control("TEXTAREA"))).toBe(true);
    expect(takesText(control("SELECT"))).toBe(true);
    expect(takesText(control("DIV", { isContentEditable: true }))).toBe(true);
  });

  it("says no for boxes, radios, sliders and buttons, which keep the focus after a click", () => {
    for (const type of ["checkbox", "radio", "range", "button", "submit", "file"]) expect(takesText(control("INPUT", { type }))).toBe(false);
    expect(takesText(control("BUTTON"))).toBe(false);
    expect(takesText(control("DIV"))).toBe(false);
  });

  it("leaves the keys to a list without typing only while it is open", () => {
    expect(takesText(control("INPUT", { type: "text", readOnly: true, expanded: "false" }))).toBe(false);
    expect(takesText(control("INPUT", { type: "text", readOnly: true, expanded: "true" }))).toBe(true);
  });
});

describe("isHarmless", () => {
  it("lets one send, search and change the view from a field, but neither mark nor hand in", () => {
    for (const id of ["search", "save.now", "frame.goto", "view.fit"]) expect(isHarmless(id)).toBe(true);
    for (const id of ["assignment.submit", "hand.propagate", "undo", "redo", "suggestion.frame", ""]) expect(isHarmless(id)).toBe(false);
  });
});

describe("keepsKey", () => {
  it("leaves Space, Enter and Tab to every control, and arrows to those that use them", () => {
    const box = control("INPUT", { type: "checkbox" });
    for (const chord of ["Space", "Enter", "Tab", "Delete"]) expect(keepsKey(box, chord)).toBe(true);
    for (const chord of ["Right", "Home", "N", "Ctrl+S"]) expect(keepsKey(box, chord)).toBe(false);
    for (const chord of ["Right", "Home", "End"]) expect(keepsKey(control("BUTTON"), chord)).toBe(false);
    for (const chord of ["Space", "Down"]) expect(keepsKey(control("BUTTON"), chord)).toBe(true);
    expect(keepsKey(control("INPUT", { type: "radio" }), "Right")).toBe(true);
    expect(keepsKey(control("BUTTON", { getAttribute: (name) => (name === "role" ? "tab" : null) }), "Right")).toBe(true);
  });
});
