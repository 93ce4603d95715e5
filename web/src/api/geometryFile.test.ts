import { expect, test } from "vitest";
import { dequantise, readGeometry } from "./geometryFile";

function pack(header: object, body: Uint8Array): ArrayBuffer {
  let text = JSON.stringify(header);
  text += " ".repeat((8 - (text.length % 8)) % 8);
  const data = new Uint8Array(8 + text.length + body.length);
  data.set(new TextEncoder().encode("HLG1"));
  new DataView(data.buffer).setUint32(4, text.length, true);
  data.set(new TextEncoder().encode(text), 8);
  data.set(body, 8 + text.length);
  return data.buffer;
}

const body = new Uint8Array(new Uint16Array([0, 1, 65535, 7, 8, 9]).buffer);
const header = { point_count: 2, arrays: [{ name: "positions", type: "uint16", shape: [2, 3], offset: 0 }] };

test("arrays and facts come out as they were put in", () => {
  const { arrays, facts } = readGeometry(pack(header, body));
  expect([...arrays["positions"]!]).toEqual([0, 1, 65535, 7, 8, 9]);
  expect(facts).toEqual({ point_count: 2 });
});

test("an answer that is cut off, or something else, is named and not drawn", () => {
  expect(() => readGeometry(pack(header, body.slice(0, 6)))).toThrow("incomplete");
  expect(() => readGeometry(pack(header, body).slice(0, 20))).toThrow("incomplete");
  expect(() => readGeometry(new TextEncoder().encode("<!doctype html>").buffer)).toThrow("no geometry");
  expect(() => readGeometry(new ArrayBuffer(0))).toThrow("no geometry");
});

test("whole numbers become metres", () => {
  expect([...dequantise([0, 10, 20, 5, 5, 5], [1, 2, 3], [0.5, 0.25, 0])]).toEqual([1, 4.5, 3, 3.5, 3.25, 3]);
});
