/** Turning scans the same way up, so that an eye that goes through hundreds of them finds everything where it was. */

export type Quaternion = readonly [number, number, number, number];
type Matrix = readonly (readonly number[])[];

/** Eigenvector of the largest eigenvalue of a symmetric matrix, by cyclic Jacobi rotations. */
function largestEigenvector(symmetric: Matrix): number[] {
  const n = symmetric.length;
  const a = symmetric.map((row) => [...row]);
  const v = a.map((_, i) => a.map((__, j) => (i === j ? 1 : 0)));
  const get = (m: number[][], i: number, j: number): number => (m[i] as number[])[j] as number;
  const put = (m: number[][], i: number, j: number, value: number): void => void ((m[i] as number[])[j] = value);
  for (let sweep = 0; sweep < 24; sweep += 1) {
    for (let p = 0; p < n; p += 1) {
      for (let q = p + 1; q < n; q += 1) {
        if (Math.abs(get(a, p, q)) < 1e-300) continue;
        const theta = (get(a, q, q) - get(a, p, p)) / (2 * get(a, p, q));
        const t = Math.sign(theta || 1) / (Math.abs(theta) + Math.hypot(theta, 1));
        const c = 1 / Math.hypot(t, 1);
        const s = t * c;
        for (let k = 0; k < n; k += 1) {
          const [kp, kq] = [get(a, k, p), get(a, k, q)];
          put(a, k, p, c * kp - s * kq);
          put(a, k, q, s * kp + c * kq);
        }
        for (let k = 0; k < n; k += 1) {
          const [pk, qk] = [get(a, p, k), get(a, q, k)];
          put(a, p, k, c * pk - s * qk);
          put(a, q, k, s * pk + c * qk);
          const [vp, vq] = [get(v, k, p), get(v, k, q)];
          put(v, k, p, c * vp - s * vq);
          put(v, k, q, s * vp + c * vq);
        }
      }
    }
  }
  const values = a.map((row, i) => row[i] as number);
  const best = values.indexOf(Math.max(...values));
  return v.map((row) => row[best] as number);
}

const meanOf = (points: ArrayLike<number>): [number, number, number] => {
  const sum: [number, number, number] = [0, 0, 0];
  for (let at = 0; at < points.length; at += 1) (sum[at % 3] as number) += points[at] as number;
  const count = Math.max(1, points.length / 3);
  return [sum[0] / count, sum[1] / count, sum[2] / count];
};

/** Rotation (xyzw) that brings points closest to as many others, after [Horn 1987]; the mean of each is taken away. */
export function rotationOnto(points: ArrayLike<number>, target: ArrayLike<number>): Quaternion {
  const [from, to] = [meanOf(points), meanOf(target)];
  const s = [0, 1, 2].map(() => [0, 0, 0]);
  for (let at = 0; at + 2 < points.length; at += 3) {
    for (let i = 0; i < 3; i += 1) {
      for (let j = 0; j < 3; j += 1) {
        ((s[i] as number[])[j] as number) += ((points[at + i] as number) - (from[i] as number)) * ((target[at + j] as number) - (to[j] as number));
      }
    }
  }
  const [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = s as [[number, number, number], [number, number, number], [number, number, number]];
  const [w, x, y, z] = largestEigenvector([
    [xx + yy + zz, yz - zy, zx - xz, xy - yx],
    [yz - zy, xx - yy - zz, xy + yx, zx + xz],
    [zx - xz, xy + yx, yy - xx - zz, yz + zy],
    [xy - yx, zx + xz, yz + zy, zz - xx - yy],
  ]) as [number, number, number, number];
  return [x, y, z, w];
}

/** The longest way through a cloud becomes up, the thinnest looks at the viewer: for scans without a registration. */
export function uprightByShape(points: ArrayLike<number>): Quaternion {
  const mean = meanOf(points);
  const c = [0, 1, 2].map(() => [0, 0, 0]);
  for (let at = 0; at + 2 < points.length; at += 3) {
    for (let i = 0; i < 3; i += 1) {
      for (let j = 0; j < 3; j += 1) {
        ((c[i] as number[])[j] as number) += ((points[at + i] as number) - (mean[i] as number)) * ((points[at + j] as number) - (mean[j] as number));
      }
    }
  }
  const up = largestEigenvector(c) as [number, number, number];
  // The thinnest: largest of the negated matrix.
  const out = largestEigenvector(c.map((row) => row.map((value) => -value))) as [number, number, number];
  const right: [number, number, number] = [up[1] * out[2] - up[2] * out[1], up[2] * out[0] - up[0] * out[2], up[0] * out[1] - up[1] * out[0]];
  return fromAxes(right, up, out);
}

/** Rotation (xyzw) that sends three orthonormal vectors to x, y and z. */
export function fromAxes(right: readonly number[], up: readonly number[], out: readonly number[]): Quaternion {
  const m = [right, up, out] as [number[], number[], number[]];
  const [m00, m01, m02, m10, m11, m12, m20, m21, m22] = m.flat() as [number, number, number, number, number, number, number, number, number];
  const trace = m00 + m11 + m22;
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    return [(m21 - m12) / s, (m02 - m20) / s, (m10 - m01) / s, s / 4];
  }
  if (m00 > m11 && m00 > m22) {
    const s = 2 * Math.sqrt(1 + m00 - m11 - m22);
    return [s / 4, (m01 + m10) / s, (m02 + m20) / s, (m21 - m12) / s];
  }
  if (m11 > m22) {
    const s = 2 * Math.sqrt(1 + m11 - m00 - m22);
    return [(m01 + m10) / s, s / 4, (m12 + m21) / s, (m02 - m20) / s];
  }
  const s = 2 * Math.sqrt(1 + m22 - m00 - m11);
  return [(m02 + m20) / s, (m12 + m21) / s, s / 4, (m10 - m01) / s];
}

/** A vector turned by a quaternion xyzw. */
export function turn([x, y, z, w]: Quaternion, [a, b, c]: readonly [number, number, number]): [number, number, number] {
  const [tx, ty, tz] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * tx + (y * tz - z * ty), b + w * ty + (z * tx - x * tz), c + w * tz + (x * ty - y * tx)];
}

/** A template in its rest pose, by which meshes of the same topology are turned the same way up. */
export interface Pattern {
  /** Fingers up, palm to the viewer; a right hand. */
  readonly vertices: Float32Array;
}

/** A right hand's template turned so that its middle finger points up and its palm faces the viewer. */
export function patternOf(vertices: Float32Array, wrist: ArrayLike<number>, tips: readonly number[]): Pattern {
  const tip = (finger: number): number[] => [0, 1, 2].map((axis) => vertices[3 * (tips[finger] as number) + axis] as number);
  const [thumb, middle, little] = [tip(0), tip(2), tip(4)] as [number[], number[], number[]];
  const up = unit(middle.map((value, axis) => value - (wrist[axis] as number)));
  const aside = thumb.map((value, axis) => value - (little[axis] as number));
  const lean = aside.reduce((sum, value, axis) => sum + value * (up[axis] as number), 0);
  const right = unit(aside.map((value, axis) => value - lean * (up[axis] as number)));
  const [a, b, c] = right as [number, number, number];
  const [d, e, f] = up as [number, number, number];
  const out = [b * f - c * e, c * d - a * f, a * e - b * d];
  const q = fromAxes(right, up, out);
  const turned = new Float32Array(vertices.length);
  for (let at = 0; at + 2 < vertices.length; at += 3) turned.set(turn(q, [vertices[at] as number, vertices[at + 1] as number, vertices[at + 2] as number]), at);
  return { vertices: turned };
}

const unit = (vector: readonly number[]): number[] => {
  const length = Math.hypot(...vector) || 1;
  return vector.map((value) => value / length);
};

/** The rotation that brings a registered mesh the way up of its template; a left hand's is its mirror image. */
export function uprightFrom(vertices: Float32Array, pattern: Pattern, side: "right" | "left"): Quaternion {
  const target = side === "right" ? pattern.vertices : pattern.vertices.map((value, at) => (at % 3 === 0 ? -value : value));
  return rotationOnto(vertices, target);
}
