/**
 * The ring of a control vertex, a step further. It depends on nothing outside itself.
 *
 * Sums run in the ring's own order, or over pairs across from each other, so that they are the same numbers whichever
 * patch computes them; those of points that are in the table too are written as there.
 *
 * @module refine/slates/ring
 */
import { REGULAR, TAGGED } from "./layout";
import type { SlateNet } from "./net";

/** Copy v and its ring to the beginning of `out`. */
export function fillRing(net: SlateNet, points: Float64Array, v: number, out: Float64Array): void {
  const { ring, ringStarts } = net;
  let o = 0;
  for (let x = 3 * v; x < 3 * v + 3; x++) out[o++] = points[x]!;
  for (let j = ringStarts[v]!; j < ringStarts[v + 1]!; j++) {
    const p = 3 * ring[j]!;
    out[o++] = points[p]!;
    out[o++] = points[p + 1]!;
    out[o++] = points[p + 2]!;
  }
}

/** From a to b; `level` steps were done before. */
export function ringStep(net: SlateNet, v: number, level: number, a: Float64Array, b: Float64Array): void {
  const begin = net.ringStarts[v]!;
  const faces = net.fans[v]!;
  const spokes = net.ringStarts[v + 1]! - begin - faces;
  const isTagged = net.kinds[v] === TAGGED;
  const f = 3 * (1 + spokes);
  for (let j = 0; j < faces; j++) {
    const e = 3 * (1 + j);
    const following = j + 1 < spokes ? e + 3 : 3;
    for (let x = 0; x < 3; x++) {
      b[f + 3 * j + x] = 0.25 * (a[x]! + a[f + 3 * j + x]! + (a[e + x]! + a[following + x]!));
    }
  }
  for (let j = 0; j < spokes; j++) {
    const share = isTagged ? Math.min(Math.max(net.spokes[begin + j]! - level, 0), 1) : 0;
    const e = 3 * (1 + j);
    const before = f + 3 * (j > 0 ? j - 1 : faces - 1);
    const after = f + 3 * (j < faces ? j : 0);
    for (let x = 0; x < 3; x++) {
      const both = a[x]! + a[e + x]!;
      let middle = 0.5 * both;
      if (share < 1) {
        const smooth = 0.25 * (both + (b[before + x]! + b[after + x]!));
        middle = share === 0 ? smooth : share * middle + (1 - share) * smooth;
      }
      b[e + x] = middle;
    }
  }
  if (isTagged) moveTagged(net, v, level, a, b);
  else moveSmooth(net, v, a, b, 1);
}

/** Add `share` times the smooth rule's point to what `share` leaves of the vertex. */
function moveSmooth(net: SlateNet, v: number, a: Float64Array, b: Float64Array, share: number): void {
  const faces = net.fans[v]!;
  const f = 3 * (1 + faces);
  const kept = (faces - 2) / faces;
  const part = 1 / (faces * faces);
  for (let x = 0; x < 3; x++) {
    if (net.kinds[v] === REGULAR) {
      const e = 3 + x;
      const spokes = a[e]! + a[e + 6]! + (a[e + 3]! + a[e + 9]!);
      const centres = b[f + x]! + b[f + 6 + x]! + (b[f + 3 + x]! + b[f + 9 + x]!);
      b[x] = 0.5 * a[x]! + 0.0625 * (spokes + centres);
      continue;
    }
    let total = 0;
    for (let j = 0; j < faces; j++) total += a[3 * (1 + j) + x]! + b[f + 3 * j + x]!;
    const point = kept * a[x]! + part * total;
    b[x] = share === 1 ? point : b[x]! + share * point;
  }
}

const CREASE = 1;
const CORNER = 2;

/** How many spokes are sharp after `level` steps, as a rule: 0 smooth, CREASE, CORNER. */
function ruleOf(net: SlateNet, v: number, level: number): number {
  const begin = net.ringStarts[v]!;
  const end = net.ringStarts[v + 1]! - net.fans[v]!;
  let count = 0;
  for (let j = begin; j < end; j++) if (net.spokes[j]! > level) count++;
  if (net.vertexSharp[v]! > level || count > 2) return CORNER;
  return count === 2 ? CREASE : 0;
}

/** How much of the present rule, where the next one is another: the mean of what ends now, at most 1. */
function blend(net: SlateNet, v: number, level: number): number {
  const begin = net.ringStarts[v]!;
  const end = net.ringStarts[v + 1]! - net.fans[v]!;
  let total = 0;
  let count = 0;
  for (let j = begin; j <= end; j++) {
    const left = (j < end ? net.spokes[j]! : net.vertexSharp[v]!) - level;
    if (!(left > 0 && left <= 1)) continue;
    total += left;
    count++;
  }
  return Math.min(total / count, 1);
}

/** By the vertex's rule; by both, weighted, in the step in which the rule changes. */
function moveTagged(net: SlateNet, v: number, level: number, a: Float64Array, b: Float64Array): void {
  const rule = ruleOf(net, v, level);
  const then = ruleOf(net, v, level + 1);
  const share = rule === then ? 1 : blend(net, v, level);
  b[0] = b[1] = b[2] = 0;
  if (share > 0) move(net, v, level, rule, share, a, b);
  if (1 - share > 0) move(net, v, level + 1, then, 1 - share, a, b);
}

/** Add a share of what a rule says, that of `level`. */
function move(
  net: SlateNet,
  v: number,
  level: number,
  rule: number,
  share: number,
  a: Float64Array,
  b: Float64Array,
): void {
  if (rule === 0) {
    moveSmooth(net, v, a, b, share);
    return;
  }
  let [first, second] = [0, 0];
  if (rule === CREASE) {
    const begin = net.ringStarts[v]!;
    const end = net.ringStarts[v + 1]! - net.fans[v]!;
    for (let j = begin; j < end; j++) {
      if (!(net.spokes[j]! > level)) continue;
      first = second;
      second = 3 * (1 + j - begin);
    }
  }
  for (let x = 0; x < 3; x++) {
    let point = a[x]!;
    if (rule === CREASE) point = 0.75 * point + 0.125 * (a[first + x]! + a[second + x]!);
    b[x]! += share * point;
  }
}
