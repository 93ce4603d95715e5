/** Raw 16-bit depth: reading it, finding a range, colouring it. A browser's canvas has only 8 bits, so this is done by hand. */

export interface DepthImage {
  readonly width: number;
  readonly height: number;
  /** Row by row, 0 where there is no value. */
  readonly raw: Uint16Array;
  /** Metres per unit. */
  readonly scale: number;
}

/** Near and far end of the colours, m. */
export interface DepthRange {
  readonly near: number;
  readonly far: number;
}

/** Near is warm, far is cold: anchors of a map that grows darker with distance, so that it also works without colour. */
const WARM: readonly (readonly [number, number, number])[] = [
  [255, 244, 214],
  [255, 200, 110],
  [246, 138, 82],
  [206, 84, 106],
  [142, 62, 130],
  [84, 56, 134],
  [46, 52, 112],
  [24, 34, 66],
];
const STEPS = 256;

const isLittleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** Colours as 32-bit words in the byte order of this machine, near first. */
const paletteOf = (anchors: readonly (readonly [number, number, number])[]): Uint32Array =>
  Uint32Array.from({ length: STEPS }, (_, step) => {
    const at = (step / (STEPS - 1)) * (anchors.length - 1);
    const below = Math.min(anchors.length - 2, Math.floor(at));
    const mix = (channel: 0 | 1 | 2): number => {
      const [low = 0, high = 0] = [anchors[below]?.[channel], anchors[below + 1]?.[channel]];
      return Math.round(low + (high - low) * (at - below));
    };
    const [r, g, b] = [mix(0), mix(1), mix(2)];
    return isLittleEndian ? ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0 : ((r << 24) | (g << 16) | (b << 8) | 255) >>> 0;
  });

/** `warm` and `viridis` grow darker with distance; `turbo` tells small steps apart; `grey` is a ground for coloured things on top. */
export const PALETTE_NAMES = ["warm", "viridis", "turbo", "grey"] as const;
export type Palette = (typeof PALETTE_NAMES)[number];

/** The anchors of each map, near first. */
export const PALETTE_ANCHORS: Record<Palette, readonly (readonly [number, number, number])[]> = {
  warm: WARM,
  viridis: [
    [253, 231, 37],
    [144, 215, 67],
    [53, 183, 121],
    [33, 145, 140],
    [49, 104, 142],
    [68, 57, 131],
    [68, 1, 84],
  ],
  turbo: [
    [122, 4, 3],
    [202, 42, 4],
    [249, 117, 29],
    [238, 207, 58],
    [164, 252, 60],
    [49, 242, 153],
    [40, 188, 235],
    [70, 107, 227],
    [48, 18, 59],
  ],
  grey: [
    [235, 237, 240],
    [40, 43, 48],
  ],
};

const PALETTES = Object.fromEntries(PALETTE_NAMES.map((name) => [name, paletteOf(PALETTE_ANCHORS[name])])) as Record<Palette, Uint32Array>;

/** Depth from the server's bytes: little-endian uint16, sizes in headers. */
export function readDepth(bytes: ArrayBuffer, headers: Headers): DepthImage {
  const width = Number(headers.get("X-Width"));
  const height = Number(headers.get("X-Height"));
  const scale = Number(headers.get("X-Depth-Scale"));
  if (!(width > 0 && height > 0 && scale > 0) || bytes.byteLength !== 2 * width * height) {
    throw new Error(`The depth image is damaged: ${bytes.byteLength} bytes for ${width} × ${height} pixels.`);
  }
  if (isLittleEndian) return { width, height, scale, raw: new Uint16Array(bytes) };
  const view = new DataView(bytes);
  return { width, height, scale, raw: Uint16Array.from({ length: width * height }, (_, index) => view.getUint16(2 * index, true)) };
}

/** Distance at the pixel nearest to a point, m; null where there is no value or no pixel. */
export function depthAt(image: DepthImage, x: number, y: number): number | null {
  const [column, row] = [Math.round(x), Math.round(y)];
  if (column < 0 || row < 0 || column >= image.width || row >= image.height) return null;
  const raw = image.raw[row * image.width + column] ?? 0;
  return raw === 0 ? null : raw * image.scale;
}

/** A range that holds nearly all values, m: 1st to 95th percentile with a little room. */
export function findRange(image: DepthImage): DepthRange {
  const sample: number[] = [];
  const step = Math.max(1, Math.floor(image.raw.length / 20000));
  for (let index = 0; index < image.raw.length; index += step) {
    const raw = image.raw[index] ?? 0;
    if (raw > 0) sample.push(raw);
  }
  if (sample.length === 0) return { near: 0.2, far: 1.5 };
  sample.sort((a, b) => a - b);
  const at = (share: number): number => (sample[Math.floor(share * (sample.length - 1))] ?? 0) * image.scale;
  const [near, far] = [at(0.01), at(0.95)];
  const room = Math.max(0.01, 0.08 * (far - near));
  return { near: Math.max(0, near - room), far: far + room };
}

/** How many pixels lie in each of some equal steps from `near` to `far`, as shares of the fullest one. */
export function histogramOf(image: DepthImage, { near, far }: DepthRange, bins: number): number[] {
  const counts = new Array<number>(bins).fill(0);
  const step = Math.max(1, Math.floor(image.raw.length / 40000));
  for (let index = 0; index < image.raw.length; index += step) {
    const raw = image.raw[index] ?? 0;
    const bin = Math.floor(((raw * image.scale - near) / Math.max(1e-9, far - near)) * bins);
    if (raw > 0 && bin >= 0 && bin < bins) counts[bin] = (counts[bin] ?? 0) + 1;
  }
  const most = Math.max(1, ...counts);
  return counts.map((count) => count / most);
}

/** Colour every pixel; without a value it stays transparent. `out` is RGBA, (height * width) words. */
export function colorDepthInto(out: Uint32Array, image: DepthImage, range: DepthRange, palette: Palette = "warm"): void {
  const colors = PALETTES[palette];
  const near = range.near / image.scale;
  const factor = (STEPS - 1) / Math.max(1e-9, range.far / image.scale - near);
  for (let index = 0; index < image.raw.length; index += 1) {
    const raw = image.raw[index] ?? 0;
    const step = Math.min(STEPS - 1, Math.max(0, Math.round((raw - near) * factor)));
    out[index] = raw === 0 ? 0 : (colors[step] ?? 0);
  }
}

/** Move the far end: a factor below 1 brings the colours nearer. */
export const scaleRange = (range: DepthRange, factor: number): DepthRange => ({
  near: range.near,
  far: range.near + Math.min(20, Math.max(0.02, (range.far - range.near) * factor)),
});

/** A canvas with the coloured depth, to be drawn like an image. */
export function paintDepth(image: DepthImage, range: DepthRange, palette: Palette): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext("2d");
  if (context) {
    const pixels = context.createImageData(image.width, image.height);
    colorDepthInto(new Uint32Array(pixels.data.buffer), image, range, palette);
    context.putImageData(pixels, 0, 0);
  }
  return canvas;
}
