import { expect, test } from "vitest";
import { colorDepthInto, depthAt, findRange, readDepth, scaleRange, type DepthImage } from "./depth";

const headers = (width: number, height: number): Headers =>
  new Headers({ "X-Width": `${width}`, "X-Height": `${height}`, "X-Depth-Scale": "0.001" });
const image: DepthImage = { width: 3, height: 2, scale: 0.001, raw: Uint16Array.from([0, 500, 600, 700, 800, 900]) };

test("depth is read as little-endian 16 bits, and damage is refused", () => {
  const bytes = new Uint8Array([0x2c, 0x01, 0x00, 0x00]).buffer;
  expect([...readDepth(bytes, headers(2, 1)).raw]).toEqual([300, 0]);
  expect(() => readDepth(bytes, headers(3, 1))).toThrow(/damaged/);
});

test("the value under the cursor is the one of the nearest pixel centre", () => {
  expect(depthAt(image, 0.6, 0.4)).toBeCloseTo(0.5, 9);
  expect(depthAt(image, 2.4, 1)).toBeCloseTo(0.9, 9);
  expect(depthAt(image, 0, 0)).toBeNull();
  expect(depthAt(image, 2.6, 0)).toBeNull();
});

test("pixels without a value stay transparent, nearer ones are brighter", () => {
  const out = new Uint32Array(6);
  colorDepthInto(out, image, { near: 0.5, far: 0.9 });
  const brightness = [...new Uint8Array(out.buffer)].reduce<number[]>((sums, value, index) => {
    if (index % 4 < 3) sums[index >> 2] = (sums[index >> 2] ?? 0) + value;
    return sums;
  }, []);
  expect(out[0]).toBe(0);
  expect(brightness.slice(1)).toEqual([...brightness.slice(1)].sort((a, b) => b - a));
});

test("the range holds the values, and an empty image has one too", () => {
  const { near, far } = findRange(image);
  expect(near).toBeLessThanOrEqual(0.5);
  expect(far).toBeGreaterThanOrEqual(0.8);
  expect(findRange({ ...image, raw: new Uint16Array(6) })).toEqual({ near: 0.2, far: 1.5 });
  expect(scaleRange({ near: 0.5, far: 1.5 }, 0.5).far).toBeCloseTo(1, 9);
});
