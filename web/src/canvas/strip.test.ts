import { expect, test } from "vitest";
import { columnMaxima, frameAtX } from "./strip";

test("one annotated frame among 10000 is seen on 500 pixels", () => {
  const values = new Float32Array(10000);
  values[7777] = 1;
  expect(columnMaxima(values, 500).reduce((sum, value) => sum + value, 0)).toBe(1);
});

test("few frames are drawn as wide bars without holes", () => {
  expect([...columnMaxima([1, 0], 4)]).toEqual([1, 1, 0, 0]);
});

test("a click on the strip finds the frame under it", () => {
  expect([frameAtX(0, 100, 10), frameAtX(99.9, 100, 10), frameAtX(500, 100, 10), frameAtX(-3, 100, 10)]).toEqual([0, 9, 9, 0]);
});
