/** What the 3D view draws: a scan and, when there is one, the mesh that was registered to it. Metres, the scan's own frame. */

/** Points, or a surface when `index` is given; three numbers a point. */
export interface Surface {
  readonly positions: Float32Array;
  /** Unit vectors, whole numbers as 127ths; without them points are drawn flat. */
  readonly normals: Float32Array | Int8Array | null;
  /** 0..255, as scanned. */
  readonly colors: Uint8Array | null;
  /** Three corners a triangle. */
  readonly index: Uint32Array | null;
  /** Distance to the other surface, mm; null where there is no other. */
  readonly errorMm: Float32Array | null;
  /** 1 where a point is left out already; null when none is. */
  readonly taken: Uint8Array | null;
}

export interface HandGeometry {
  readonly scan: Surface;
  readonly mesh: Surface | null;
  readonly side: "right" | "left" | null;
  /** Turns the scan so that fingers point up and the palm faces the viewer, quaternion xyzw. */
  readonly upright: readonly [number, number, number, number];
  /** What the eye is to see; left out, the mesh or else the scan. */
  readonly box?: Box;
  /** About how far points lie apart, m; left out, it is measured. */
  readonly spacing?: number;
}

export interface Box {
  readonly centre: readonly [number, number, number];
  /** Half of the diagonal. */
  readonly radius: number;
}

/** The box around points. */
export function boxOf(positions: Float32Array): Box {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let at = 0; at < positions.length; at += 1) {
    const value = positions[at] as number;
    const axis = at % 3;
    if (value < (low[axis] as number)) low[axis] = value;
    if (value > (high[axis] as number)) high[axis] = value;
  }
  if (positions.length === 0) return { centre: [0, 0, 0], radius: 0.1 };
  const [x, y, z] = low.map((value, axis) => (value + (high[axis] as number)) / 2) as [number, number, number];
  const radius = Math.hypot(...low.map((value, axis) => ((high[axis] as number) - value) / 2));
  return { centre: [x, y, z], radius: radius || 0.01 };
}

/** About how far points lie apart, m: from the number of 4 mm cells that they fill. */
export function spacingOf(positions: Float32Array): number {
  const cell = 0.004;
  const filled = new Set<number>();
  for (let at = 0; at + 2 < positions.length; at += 3) {
    const [x, y, z] = [0, 1, 2].map((axis) => Math.floor((positions[at + axis] as number) / cell) & 0x3ff) as [number, number, number];
    filled.add(x | (y << 10) | (z << 20));
  }
  // A surface crosses a cell in about two thirds of the cell's face.
  return Math.sqrt((filled.size * cell * cell * 0.66) / Math.max(1, positions.length / 3));
}

/** Every edge of triangles once, two corners each. */
export function edgesOf(index: Uint32Array): Uint32Array {
  const seen = new Set<number>();
  const edges: number[] = [];
  for (let at = 0; at + 2 < index.length; at += 3) {
    for (let corner = 0; corner < 3; corner += 1) {
      const a = index[at + corner] as number;
      const b = index[at + ((corner + 1) % 3)] as number;
      const key = Math.min(a, b) * 0x4000000 + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      edges.push(a, b);
    }
  }
  return Uint32Array.from(edges);
}

/** Area-weighted normals of a surface's corners. */
export function normalsOf(positions: Float32Array, index: Uint32Array): Float32Array {
  const normals = new Float32Array(positions.length);
  const at = (corner: number, axis: number): number => positions[3 * corner + axis] as number;
  for (let face = 0; face + 2 < index.length; face += 3) {
    const [a, b, c] = [index[face], index[face + 1], index[face + 2]] as [number, number, number];
    const u = [0, 1, 2].map((axis) => at(b, axis) - at(a, axis)) as [number, number, number];
    const v = [0, 1, 2].map((axis) => at(c, axis) - at(a, axis)) as [number, number, number];
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const corner of [a, b, c]) normal.forEach((value, axis) => (normals[3 * corner + axis] = (normals[3 * corner + axis] as number) + value));
  }
  for (let corner = 0; corner + 2 < normals.length; corner += 3) {
    const length = Math.hypot(normals[corner] as number, normals[corner + 1] as number, normals[corner + 2] as number) || 1;
    for (let axis = 0; axis < 3; axis += 1) normals[corner + axis] = (normals[corner + axis] as number) / length;
  }
  return normals;
}
