/** What patches are computed in: two slates with their corners' rings, of a fixed size; and what comes out. */
import type { SlateNet } from "./net";

/** Two slates, used in turn. */
export interface Work {
  /** (2^depth + 3)^2 points each. The narrow slates of borders, three rows of 2^depth + 1, fit into the same. */
  readonly slates: readonly [Float64Array, Float64Array];
  /** Of four corners, twice; as long as the longest ring of the control mesh. */
  readonly rings: readonly [readonly Float64Array[], readonly Float64Array[]];
}

/** Columns of three. */
export type Column = Float32Array | Float64Array;

/** Limit points and unit normals. */
export interface Rows {
  readonly positions: Column;
  readonly normals: Column;
}

/** For patches up to a depth. */
export function workOf({ ringStarts }: SlateNet, depth: number): Work {
  let longest = 0;
  for (let v = 0; v + 1 < ringStarts.length; v++) {
    longest = Math.max(longest, ringStarts[v + 1]! - ringStarts[v]!);
  }
  const slate = () => new Float64Array(3 * ((1 << depth) + 3) ** 2);
  const rings = () => Array.from({ length: 4 }, () => new Float64Array(3 * (1 + longest)));
  return { slates: [slate(), slate()], rings: [rings(), rings()] };
}

/** Row o of normals: the unit normal of tangents a and b, zero where they have no direction. */
export function putNormal(
  normals: Column,
  o: number,
  ax: number,
  ay: number,
  az: number,
  bx: number,
  by: number,
  bz: number,
): void {
  const x = ay * bz - az * by;
  const y = az * bx - ax * bz;
  const z = ax * by - ay * bx;
  const length = Math.sqrt(x * x + y * y + z * z);
  const share = length > 0 ? 1 / length : 0;
  // The zero added makes -0 the other zero.
  normals[3 * o] = x * share + 0;
  normals[3 * o + 1] = y * share + 0;
  normals[3 * o + 2] = z * share + 0;
}
