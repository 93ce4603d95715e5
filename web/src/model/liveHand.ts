/** A model's mesh at rest for a person's shape, [R17] Eq. 2 without a pose. */

/**
 * @param vertices (V, 3) template, m.
 * @param directions (V, 3, S) m for one standard deviation, row by row.
 * @param shape how many standard deviations of each component; what is missing is 0.
 */
export function shapeHand(vertices: Float32Array, directions: Float32Array, count: number, shape: readonly number[]): Float32Array {
  const made = vertices.slice();
  for (let component = 0; component < Math.min(count, shape.length); component += 1) {
    const weight = shape[component] as number;
    if (weight === 0) continue;
    for (let at = 0; at < made.length; at += 1) made[at] = (made[at] as number) + weight * (directions[at * count + component] as number);
  }
  return made;
}
