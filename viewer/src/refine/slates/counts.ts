/**
 * How deep sides are, and how many triangles that makes. An entry is placement · m + patch.
 *
 * @module refine/slates/counts
 */
import { NONE } from "./layout";
import type { SlateNet } from "./net";

/** The depth of side k: the larger of those of its faces, in one placement; of what is not shown NONE. */
export function sideDepth(
  mates: Int32Array,
  depths: Int8Array,
  entry: number,
  k: number,
  patches: number,
): number {
  const depth = depths[entry]!;
  const f = entry % patches;
  const beyond = mates[4 * f + k]!;
  if (beyond < 0 || depth < 0) return depth;
  const other = depths[entry - f + (beyond >> 2)]!;
  return other > depth ? other : depth;
}

/** Of each side of each entry. */
export function sideDepths({ mates }: SlateNet, depths: Int8Array, out: Int8Array): void {
  const patches = mates.length / 4;
  for (let entry = 0; entry < depths.length; entry++) {
    for (let k = 0; k < 4; k++) out[4 * entry + k] = sideDepth(mates, depths, entry, k, patches);
  }
}

/** Of a patch of depth d with sides of these depths. */
export function trianglesOf(d: number, first: number, second: number, third: number, fourth: number): number {
  if (d < 0) return 0;
  const n = 1 << d;
  const rows = (first > d ? 1 : 0) + (third > d ? 1 : 0);
  const columns = (second > d ? 1 : 0) + (fourth > d ? 1 : 0);
  if (rows + columns === 0) return 2 * n * n;
  const fans = n === 1 ? 1 : (rows + columns) * n - rows * columns;
  const pieces = 4 * fans + (1 << first) + (1 << second) + (1 << third) + (1 << fourth) - 4 * n;
  return 2 * (n * n - fans) + pieces + (rows + columns) * 2 * (n - 1);
}

function trianglesAt(mates: Int32Array, depths: Int8Array, entry: number, patches: number): number {
  const side = (k: number) => sideDepth(mates, depths, entry, k, patches);
  return trianglesOf(depths[entry]!, side(0), side(1), side(2), side(3));
}

/** Of all entries. */
export function countTriangles({ mates }: SlateNet, depths: Int8Array): number {
  let total = 0;
  for (let entry = 0; entry < depths.length; entry++) {
    total += trianglesAt(mates, depths, entry, mates.length / 4);
  }
  return total;
}

/** Take entries in order to their upper depth, as many as a budget allows; `total` are there before. */
export function rise(
  { mates }: SlateNet,
  depths: Int8Array,
  order: Iterable<number>,
  upper: Int8Array,
  budget: number,
  total: number,
): void {
  let left = budget - total;
  for (const entry of order) {
    const depth = depths[entry]!;
    left += trianglesAround(mates, depths, entry);
    depths[entry] = upper[entry]!;
    left -= trianglesAround(mates, depths, entry);
    if (left >= 0) continue;
    depths[entry] = depth;
    return;
  }
}

/** Of an entry and those beside it, each once. */
function trianglesAround(mates: Int32Array, depths: Int8Array, entry: number): number {
  const patches = mates.length / 4;
  const f = entry % patches;
  let total = trianglesAt(mates, depths, entry, patches);
  for (let k = 0; k < 4; k++) {
    const beyond = mates[4 * f + k]! >> 2;
    let isFirst = beyond !== NONE; // -1 >> 2 is -1
    for (let j = 0; j < k; j++) isFirst &&= mates[4 * f + j]! >> 2 !== beyond;
    if (isFirst) total += trianglesAt(mates, depths, entry - f + beyond, patches);
  }
  return total;
}
