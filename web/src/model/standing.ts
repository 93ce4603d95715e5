/** How people stand in scans, so that every moving scan is looked at from the front. */

import { fromAxes, type Quaternion } from "./upright";

type Vector = [number, number, number];

const UP_Y: Vector = [0, 1, 0];
const UP_Z: Vector = [0, 0, 1];
/** Z points up where the box is so many times as high along it as along y. */
const CLEARLY = 1.2;
/** Shares of a person's height: feet reach so high, and shins stand between. */
const FEET = 0.04;
const SHINS: readonly [number, number] = [0.1, 0.25];

/** Rotation (xyzw) that brings a person upright: y or z up, whichever is longer, the broad side and the toes to the viewer. */
export function standingUp(positions: ArrayLike<number>): Quaternion {
  const size = extentOf(positions);
  const up = size[2] > CLEARLY * size[1] ? UP_Z : UP_Y;
  const flat: readonly [number, number] = up === UP_Z ? [0, 1] : [0, 2];
  const broad = broadAxis(positions, flat);
  const right: Vector = [0, 0, 0];
  right[flat[0]] = broad[0];
  right[flat[1]] = broad[1];
  const out: Vector = [right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2], right[0] * up[1] - right[1] * up[0]];
  if (toesAlong(positions, up === UP_Z ? 2 : 1, size, out) >= 0) return fromAxes(right, up, out);
  return fromAxes(right.map((value) => -value), up, out.map((value) => -value));
}

/** How far the feet lie before the shins along a direction; 0 where a scan lacks either. */
function toesAlong(positions: ArrayLike<number>, up: 1 | 2, size: Vector, direction: Vector): number {
  let lowest = Infinity;
  for (let at = up; at < positions.length; at += 3) lowest = Math.min(lowest, positions[at] as number);
  const [feet, shins] = [{ sum: 0, count: 0 }, { sum: 0, count: 0 }];
  for (let at = 0; at + 2 < positions.length; at += 3) {
    const height = ((positions[at + up] as number) - lowest) / size[up];
    const band = height < FEET ? feet : height > SHINS[0] && height < SHINS[1] ? shins : null;
    if (!band) continue;
    band.sum += direction.reduce((sum, value, axis) => sum + value * (positions[at + axis] as number), 0);
    band.count += 1;
  }
  return feet.count > 0 && shins.count > 0 ? feet.sum / feet.count - shins.sum / shins.count : 0;
}

function extentOf(positions: ArrayLike<number>): Vector {
  const low: Vector = [Infinity, Infinity, Infinity];
  const high: Vector = [-Infinity, -Infinity, -Infinity];
  for (let at = 0; at < positions.length; at += 1) {
    const axis = (at % 3) as 0 | 1 | 2;
    low[axis] = Math.min(low[axis], positions[at] as number);
    high[axis] = Math.max(high[axis], positions[at] as number);
  }
  return [high[0] - low[0], high[1] - low[1], high[2] - low[2]];
}

/** The direction in a plane along which points lie farthest apart; of its two ends the one with the larger first number. */
function broadAxis(positions: ArrayLike<number>, [a, b]: readonly [number, number]): [number, number] {
  const count = Math.max(1, positions.length / 3);
  let [meanA, meanB] = [0, 0];
  for (let at = 0; at + 2 < positions.length; at += 3) {
    meanA += (positions[at + a] as number) / count;
    meanB += (positions[at + b] as number) / count;
  }
  let [aa, ab, bb] = [0, 0, 0];
  for (let at = 0; at + 2 < positions.length; at += 3) {
    const [p, q] = [(positions[at + a] as number) - meanA, (positions[at + b] as number) - meanB];
    aa += p * p;
    ab += p * q;
    bb += q * q;
  }
  const angle = 0.5 * Math.atan2(2 * ab, aa - bb);
  const axis: [number, number] = [Math.cos(angle), Math.sin(angle)];
  return axis[0] < 0 ? [-axis[0], -axis[1]] : axis;
}
