/** The binary answers that carry points and meshes: arrays are laid over the bytes, nothing is copied. */

interface ArrayPlace {
  readonly name: string;
  readonly type: keyof typeof KINDS;
  readonly shape: readonly number[];
  readonly offset: number;
}

const KINDS = { uint8: Uint8Array, int8: Int8Array, uint16: Uint16Array, uint32: Uint32Array, float32: Float32Array } as const;

type Numbers = InstanceType<(typeof KINDS)[keyof typeof KINDS]>;

export interface GeometryFile {
  readonly arrays: Readonly<Record<string, Numbers>>;
  /** What else the header says. */
  readonly facts: Readonly<Record<string, unknown>>;
}

/** "HLG1", the header's length (uint32, little-endian), the header as JSON, the arrays at their offsets behind it. */
export function readGeometry(data: ArrayBuffer): GeometryFile {
  const mark = new TextDecoder("latin1").decode(data.slice(0, 4));
  if (mark !== "HLG1" || data.byteLength < 8) throw new Error("This is no geometry that this version of the app can read. Load the page again.");
  const length = new DataView(data).getUint32(4, true);
  if (8 + length > data.byteLength) throw new Error("The geometry arrived incomplete. Reload the page.");
  const { arrays: places, ...facts } = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 8, length))) as { arrays: ArrayPlace[] };
  const arrays = Object.fromEntries(
    places.map(({ name, type, shape, offset }) => {
      const Kind = KINDS[type];
      const count = shape.reduce((product, size) => product * size, 1);
      const start = 8 + length + offset;
      if (start + count * Kind.BYTES_PER_ELEMENT > data.byteLength) throw new Error("The geometry arrived incomplete. Reload the page.");
      return [name, new Kind(data, start, count)];
    }),
  );
  return { arrays, facts };
}

/** Whole numbers over a box as metres: origin + step * number, axis by axis. */
export function dequantise(numbers: ArrayLike<number>, origin: readonly number[], step: readonly number[]): Float32Array {
  const metres = new Float32Array(numbers.length);
  for (let at = 0; at < numbers.length; at += 1) metres[at] = (origin[at % 3] as number) + (step[at % 3] as number) * (numbers[at] as number);
  return metres;
}
