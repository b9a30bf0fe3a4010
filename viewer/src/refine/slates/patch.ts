/**
 * A patch by two slates: a step from one into the other until the depth is reached, then limit points.
 *
 * A table of depth d is 2^d + 3 points a side: the patch and a ring around it. Inside, one rule for all; sides that are
 * sharp and corners of other than four smooth faces are done anew after each step. Every sum is one that does not
 * change when the patch is turned, and a limit is taken in the step in which its point is new, so that two patches
 * agree on a border to the last bit, whatever their depths are.
 *
 * Based on: V. Settgast, K. Müller, Chr. Fünfzig, D. Fellner. Adaptive tessellation of subdivision surfaces, section 3.2.
 *
 * @module refine/slates/patch
 */
import { LIMIT_SHARE, MOST_DEPTH, REGULAR } from "./layout";
import type { Limits } from "./limits";
import { SIDE_WORDS } from "./masks";
import type { SlateNet } from "./net";
import { fillRing, ringStep } from "./ring";
import { type SideRule, sideAhead, sideBegin, sideInside, sidePoint, sideStep } from "./sides";
import { putNormal, type Rows, type Work } from "./work";

/** (2^depth + 1)^2 rows of `out` from row `place` on; row by row of patch f. */
export function tessellate(
  net: SlateNet,
  work: Work,
  limits: Limits,
  f: number,
  place: number,
  depth: number,
  out: Rows,
  isSurface: boolean,
): void {
  const isPlain = gather(net, work, limits.points, f);
  let n = 4;
  for (let level = 0; level < depth; level++) {
    const a = work.slates[level & 1]!;
    const b = work.slates[1 - (level & 1)]!;
    step(a, b, n);
    if (!isPlain) mend(net, work, f, level, n);
    n = 2 * n - 3;
    innerLimits(b, n, place, depth - level - 1, out, isSurface);
    if (!isPlain) sideLimits(net, b, n, f, place, level + 1, depth, out, isSurface);
  }
  cornerLimits(net, limits, f, place, depth, out, isSurface);
}

/** Fill the table, and the rings of corners that need them; whether there is nothing but the table's rule. */
function gather(net: SlateNet, work: Work, points: Float64Array, f: number): boolean {
  const slate = work.slates[0];
  for (let i = 0; i < 16; i++) {
    const p = 3 * net.grid[16 * f + i]!;
    for (let x = 0; x < 3; x++) slate[3 * i + x] = points[p + x]!;
  }
  let isPlain = true; // a sharp side has tagged corners
  for (let k = 0; k < 4; k++) {
    const v = net.corners[4 * f + k]!;
    if (net.kinds[v] === REGULAR) continue;
    isPlain = false;
    fillRing(net, points, v, work.rings[0][k]!);
  }
  return isPlain;
}

/** From a table of n a side to one of 2 n - 3: face points, then edge points and old vertices. */
function step(a: Float64Array, b: Float64Array, n: number): void {
  const row = 3 * n;
  const after = 3 * (2 * n - 3);
  for (let r = 0; r < n - 1; r++) {
    let q = 2 * r * after;
    for (let p = r * row; p < r * row + row - 3; p += 3, q += 6) {
      for (let x = 0; x < 3; x++) {
        b[q + x] = 0.25 * (a[p + x]! + a[p + row + 3 + x]! + (a[p + 3 + x]! + a[p + row + x]!));
      }
    }
  }
  edgesDown(a, b, n);
  edgesAcross(a, b, n);
}

/** Edge points between face points one above the other. */
function edgesDown(a: Float64Array, b: Float64Array, n: number): void {
  const row = 3 * n;
  const after = 3 * (2 * n - 3);
  for (let r = 1; r < n - 1; r++) {
    let q = 2 * r * after;
    for (let p = r * row; p < r * row + row - 3; p += 3, q += 6) {
      for (let k = 0; k < 3; k++) {
        b[q - after + k] = 0.25 * (a[p + k]! + a[p + 3 + k]! + (b[q + k]! + b[q - 2 * after + k]!));
      }
    }
  }
}

/** Edge points between face points beside each other, and old vertices in the middle of four. */
function edgesAcross(a: Float64Array, b: Float64Array, n: number): void {
  const row = 3 * n;
  const after = 3 * (2 * n - 3);
  for (let r = 0; r < n - 1; r++) {
    let p = r * row + 3;
    let q = 2 * r * after + 6;
    const end = r * row + row - 3;
    for (; p < end; p += 3, q += 6) {
      for (let k = 0; k < 3; k++) {
        b[q - 3 + k] = 0.25 * (a[p + k]! + a[p + row + k]! + (b[q + k]! + b[q - 6 + k]!));
      }
      if (r === 0) continue;
      const up = q - 2 * after;
      for (let k = 0; k < 3; k++) {
        const edges = a[p + 3 + k]! + a[p - 3 + k]! + (a[p + row + k]! + a[p - row + k]!);
        const centres = b[q + k]! + b[up - 6 + k]! + (b[up + k]! + b[q - 6 + k]!);
        b[q - after - 3 + k] = 0.5 * a[p + k]! + 0.0625 * (edges + centres);
      }
    }
  }
}

/** After a step: what is sharp on sides, then corners with their two spokes outside the patch. */
function mend(net: SlateNet, work: Work, f: number, level: number, n: number): void {
  const a = work.slates[level & 1]!;
  const b = work.slates[1 - (level & 1)]!;
  for (let k = 0; k < 4; k++) {
    const share = Math.min(net.sharp[4 * f + k]! - level, 1);
    if (share > 0) sideStep(k, share, a, n, b);
  }
  const m = 2 * n - 3;
  for (let k = 0; k < 4; k++) {
    const h = 4 * f + k;
    const v = net.corners[h]!;
    if (net.kinds[v] === REGULAR) continue;
    const ring = work.rings[1 - (level & 1)]![k]!;
    ringStep(net, v, level, work.rings[level & 1]![k]!, ring);
    const [q, ahead, inside] = [sideBegin(k, m), sideAhead(k, m), sideInside(k, m)];
    put(ring, 0, b, q);
    const spokes = net.ringStarts[v + 1]! - net.ringStarts[v]! - net.fans[v]!;
    const o = net.place[h]!;
    const isOpen = spokes > net.fans[v]!;
    if (o > 0 || !isOpen) put(ring, 3 * (o > 0 ? o : spokes), b, q - inside);
    if (o + 2 < spokes) put(ring, 3 * (o + 3), b, q - ahead);
    else if (!isOpen) put(ring, 3 * (o + 3 - spokes), b, q - ahead);
  }
}

/** A point of a ring into the table. */
function put(ring: Float64Array, i: number, table: Float64Array, q: number): void {
  for (let x = 0; x < 3; x++) table[q + x] = ring[i + x]!;
}

/** Limit points and normals by the rule of four faces, of points new in this step; `left` are to do. */
function innerLimits(
  a: Float64Array,
  n: number,
  place: number,
  left: number,
  out: Rows,
  isSurface: boolean,
): void {
  const size = ((n - 3) << left) + 1;
  for (let r = 1; r < n - 1; r++) {
    const first = 1 + (r % 2);
    let o = place + ((r - 1) << left) * size + ((first - 1) << left);
    for (let c = first; c < n - 1; c += first) {
      innerPoint(a, 3 * (r * n + c), 3 * n, out, o, isSurface);
      o += first << left;
    }
  }
}

function innerPoint(a: Float64Array, p: number, row: number, out: Rows, o: number, isSurface: boolean): void {
  const { positions } = out;
  for (let x = 0; x < 3; x++) {
    const i = p + x;
    const edges = a[i + 3]! + a[i - 3]! + (a[i + row]! + a[i - row]!);
    const diagonal = a[i + row + 3]! + a[i - row - 3]! + (a[i + row - 3]! + a[i - row + 3]!);
    positions[3 * o + x] = (16 * a[i]! + 4 * edges + diagonal) * LIMIT_SHARE;
  }
  if (isSurface) innerNormal(a, p, row, out, o);
}

function innerNormal(a: Float64Array, p: number, row: number, { normals }: Rows, o: number): void {
  const ax = ahead(a, p, row);
  const ay = ahead(a, p + 1, row);
  const az = ahead(a, p + 2, row);
  const bx = below(a, p, row);
  const by = below(a, p + 1, row);
  const bz = below(a, p + 2, row);
  putNormal(normals, o, ax, ay, az, bx, by, bz);
}

function ahead(a: Float64Array, i: number, row: number): number {
  const over = a[i + row + 3]! + a[i - row + 3]! - (a[i + row - 3]! + a[i - row - 3]!);
  return 4 * (a[i + 3]! - a[i - 3]!) + over;
}

function below(a: Float64Array, i: number, row: number): number {
  const over = a[i + row + 3]! + a[i + row - 3]! - (a[i - row - 3]! + a[i - row + 3]!);
  return 4 * (a[i + row]! - a[i - row]!) + over;
}

/** Points new inside sharp sides anew. */
function sideLimits(
  net: SlateNet,
  a: Float64Array,
  n: number,
  f: number,
  place: number,
  level: number,
  depth: number,
  out: Rows,
  isSurface: boolean,
): void {
  const size = (1 << depth) + 1;
  const stride = 1 << (depth - level);
  for (let k = 0; k < 4; k++) {
    const h = 4 * f + k;
    const left = net.sharp[h]! - level;
    if (!(left > 0)) continue;
    const [p, onwards] = [sideBegin(k, n), sideAhead(k, n)];
    const rule: SideRule = {
      ahead: onwards,
      inside: sideInside(k, n),
      left,
      masks: net.sideMasks,
      at: maskRow(net, h, level),
    };
    const row = place + sideRow(k, size);
    for (let i = 1; i < n - 3; i += 2) {
      sidePoint(a, p + i * onwards, rule, isSurface, out, row + i * stride * sideRowAhead(k, size));
    }
  }
}

/** Where the weights of side h after `level` steps begin. */
export function maskRow(net: SlateNet, h: number, level: number): number {
  return SIDE_WORDS * ((MOST_DEPTH + 1) * net.sideClass[h]! + level);
}

/** Of side k in a patch's block of size by size rows: its first row. */
export function sideRow(k: number, size: number): number {
  return k === 0 ? 0 : k === 1 ? size - 1 : k === 2 ? size * size - 1 : size * (size - 1);
}

/** From point to point of it. */
export function sideRowAhead(k: number, size: number): number {
  return k === 0 ? 1 : k === 1 ? size : k === 2 ? -1 : -size;
}

/** The four corners, which were computed once for all patches. */
function cornerLimits(
  net: SlateNet,
  limits: Limits,
  f: number,
  place: number,
  depth: number,
  out: Rows,
  isSurface: boolean,
): void {
  for (let k = 0; k < 4; k++) {
    limits.put(net, 4 * f + k, place + sideRow(k, (1 << depth) + 1), out, isSurface);
  }
}
