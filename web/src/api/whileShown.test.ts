import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { HIDDEN_MS, whileShown } from "./whileShown";

const page = Object.assign(new EventTarget(), { visibilityState: "visible" });
const turn = (state: "visible" | "hidden"): void => {
  page.visibilityState = state;
  page.dispatchEvent(new Event("visibilitychange"));
};

beforeEach(() => {
  vi.useFakeTimers();
  page.visibilityState = "visible";
  vi.stubGlobal("document", page);
  vi.stubGlobal("window", new EventTarget());
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function watch() {
  const told: string[] = [];
  return { told, stop: whileShown(() => told.push("begin"), () => told.push("end")) };
}

it("begins at once, and ends once and for all", () => {
  const { told, stop } = watch();
  stop();
  turn("hidden");
  turn("visible");
  window.dispatchEvent(new Event("pageshow"));
  vi.runAllTimers();
  expect(told).toEqual(["begin", "end"]);
});

it("goes on in a page that is hidden for a moment, and ends in one that stays hidden until it is shown again", () => {
  const { told } = watch();
  turn("hidden");
  vi.advanceTimersByTime(HIDDEN_MS - 1);
  turn("visible");
  vi.advanceTimersByTime(10 * HIDDEN_MS);
  expect(told).toEqual(["begin"]);
  turn("hidden");
  vi.advanceTimersByTime(HIDDEN_MS);
  expect(told).toEqual(["begin", "end"]);
  turn("visible");
  expect(told).toEqual(["begin", "end", "begin"]);
});

it("ends as soon as the page is left, and begins again when the browser brings it back", () => {
  const { told } = watch();
  window.dispatchEvent(new Event("pagehide"));
  expect(told).toEqual(["begin", "end"]);
  window.dispatchEvent(new Event("pageshow"));
  expect(told).toEqual(["begin", "end", "begin"]);
});

it("ends in a page that was opened behind others and never looked at", () => {
  page.visibilityState = "hidden";
  const { told } = watch();
  vi.advanceTimersByTime(HIDDEN_MS);
  expect(told).toEqual(["begin", "end"]);
});
