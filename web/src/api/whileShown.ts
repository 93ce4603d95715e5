/** Connections that a page holds only while somebody looks at it. */

/** A page that is hidden for longer gives its connection back, ms. */
export const HIDDEN_MS = 10_000;

/**
 * Begin now, end when the page is left or hidden, and begin again when it comes back. A browser has six connections to a
 * server for all tabs together, and pages that one leaves keep theirs for the way back: the seventh page would not load.
 *
 * Returns the way to end it for good.
 */
export function whileShown(begin: () => void, end: () => void): () => void {
  let isOn = false;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const on = (): void => {
    clearTimeout(timer);
    if (!isOn) begin();
    isOn = true;
  };
  const off = (): void => {
    clearTimeout(timer);
    if (isOn) end();
    isOn = false;
  };
  const look = (): void => {
    if (document.visibilityState !== "hidden") return on();
    clearTimeout(timer);
    timer = setTimeout(off, HIDDEN_MS);
  };
  document.addEventListener("visibilitychange", look);
  window.addEventListener("pagehide", off);
  window.addEventListener("pageshow", on);
  on();
  look();
  return () => {
    document.removeEventListener("visibilitychange", look);
    window.removeEventListener("pagehide", off);
    window.removeEventListener("pageshow", on);
    off();
  };
}
