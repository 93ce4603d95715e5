/** The closest points of a mesh to a few others. */

type Vector = readonly [number, number, number];

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const along = (a: Vector, s: number, u: Vector, t = 0, v: Vector = u): Vector => [a[0] + s * u[0] + t * v[0], a[1] + s * u[1] + t * v[1], a[2] + s * u[2] + t * v[2]];

/** Closest point of a triangle, by the region of its plane that the point lies over [Ericson 2005, 5.1.5]. */
export function closestOnTriangle(p: Vector, a: Vector, b: Vector, c: Vector): Vector {
  const [ab, ac, ap] = [minus(b, a), minus(c, a), minus(p, a)];
  const [d1, d2] = [dot(ab, ap), dot(ac, ap)];
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = minus(p, b);
  const [d3, d4] = [dot(ab, bp), dot(ac, bp)];
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return along(a, d1 / (d1 - d3), ab);
  const cp = minus(p, c);
  const [d5, d6] = [dot(ab, cp), dot(ac, cp)];
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return along(a, d2 / (d2 - d6), ac);
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return along(b, (d4 - d3) / (d4 - d3 + d5 - d6), minus(c, b));
  const sum = va + vb + vc;
  return sum === 0 ? a : along(a, vb / sum, ab, vc / sum, ac);
}

/**
 * For each point the closest one on the triangles around its nearest corner: what a line in a picture needs. Where a
 * triangle is longer than the surface is bent it may not be the closest of all.
 */
export function closestOnMesh(points: Float32Array, positions: Float32Array, index: Uint32Array): Float32Array {
  const corner = (at: number): Vector => [positions[3 * at] as number, positions[3 * at + 1] as number, positions[3 * at + 2] as number];
  const around: number[][] = Array.from({ length: positions.length / 3 }, () => []);
  index.forEach((vertex, place) => around[vertex]?.push(3 * Math.floor(place / 3)));
  const found = new Float32Array(points.length);
  for (let point = 0; point + 2 < points.length; point += 3) {
    const p: Vector = [points[point] as number, points[point + 1] as number, points[point + 2] as number];
    let nearest = 0;
    let least = Infinity;
    for (let vertex = 0; 3 * vertex < positions.length; vertex += 1) {
      const off = minus(corner(vertex), p);
      const squared = dot(off, off);
      if (squared < least) [nearest, least] = [vertex, squared];
    }
    let best = corner(nearest);
    for (const face of around[nearest] ?? []) {
      const one = closestOnTriangle(p, ...([0, 1, 2].map((at) => corner(index[face + at] as number)) as [Vector, Vector, Vector]));
      const off = minus(one, p);
      if (dot(off, off) < least) [best, least] = [one, dot(off, off)];
    }
    found.set(best, point);
  }
  return found;
}
