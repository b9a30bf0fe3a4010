/**
 * The points of one side of a patch at any depth, by a slate of three rows: outside, on it, inside.
 *
 * A step needs no more than these, so the work is linear in the points. Corners come from their rings on both ends; all
 * rules are written as in the table, so that the numbers are those the deeper patch beyond has.
 *
 * @module refine/slates/rims
 */
import type { Limits } from "./limits";
import type { SlateNet } from "./net";
import { maskRow } from "./patch";
import { fillRing, ringStep } from "./ring";
import { type SideRule, sidePoint } from "./sides";
import type { Rows, Work } from "./work";

/** 2^depth + 1 rows of `out` for side h, corner to corner, with the normals of its own patch. */
export function rim(
  net: SlateNet,
  work: Work,
  limits: Limits,
  h: number,
  place: number,
  depth: number,
  out: Rows,
  isSurface: boolean,
): void {
  const after = h - (h % 4) + ((h + 1) % 4);
  begin(net, work, limits.points, h, after);
  let n = 2;
  for (let level = 0; level < depth; level++) {
    step(net, work, h, after, level, n);
    n = 2 * n - 1;
    const stride = 1 << (depth - level - 1);
    const left = net.sharp[h]! - level - 1;
    const at = maskRow(net, h, level + 1);
    const rule: SideRule = { ahead: 3, inside: 3 * n, left, masks: net.sideMasks, at };
    const slate = work.slates[1 - (level & 1)]!;
    for (let c = 1; c < n - 1; c += 2) {
      sidePoint(slate, 3 * (n + c), rule, isSurface, out, place + c * stride);
    }
  }
  limits.put(net, h, place, out, isSurface);
  limits.put(net, after, place + (1 << depth), out, isSurface);
}

/** Rows of two points, and the rings of both ends. */
function begin(net: SlateNet, work: Work, points: Float64Array, h: number, after: number): void {
  for (const [end, corner] of [h, after].entries()) {
    const ring = work.rings[0][end]!;
    fillRing(net, points, net.corners[corner]!, ring);
    putEnd(net, corner, end, ring, work.slates[0], 2);
  }
}

/** An end's three points into rows of n; what is absent outside is the corner itself. */
function putEnd(
  net: SlateNet,
  corner: number,
  end: number,
  ring: Float64Array,
  a: Float64Array,
  n: number,
): void {
  const v = net.corners[corner]!;
  const spokes = net.ringStarts[v + 1]! - net.ringStarts[v]! - net.fans[v]!;
  const isOpen = spokes > net.fans[v]!;
  // Seen from the first end the side is spoke o and o + 1 is inside; from the second it is o + 1, o inside.
  const inside = net.place[corner]! + (1 - end);
  const outside = net.place[corner]! + (end ? 2 : -1);
  const isAbsent = isOpen && !(outside >= 0 && outside < spokes);
  const i = 3 * (1 + (inside % spokes));
  const o = isAbsent ? 0 : 3 * (1 + ((outside + spokes) % spokes));
  const at = 3 * (n - 1) * end;
  for (let x = 0; x < 3; x++) {
    a[at + x] = ring[o + x]!;
    a[3 * n + at + x] = ring[x]!;
    a[6 * n + at + x] = ring[i + x]!;
  }
}

/** From rows of n points to rows of 2 n - 1. */
function step(net: SlateNet, work: Work, h: number, after: number, level: number, n: number): void {
  const a = work.slates[level & 1]!;
  const b = work.slates[1 - (level & 1)]!;
  const m = 3 * (2 * n - 1);
  for (let r = 0; r < 2; r++) {
    // face points: in rows 0 and 2
    for (let c = 0; c < n - 1; c++) {
      const p = 3 * (r * n + c);
      const q = 2 * r * m + 6 * c + 3;
      for (let x = 0; x < 3; x++) {
        b[q + x] = 0.25 * (a[p + x]! + a[p + x + 3 * n + 3]! + (a[p + x + 3]! + a[p + x + 3 * n]!));
      }
    }
  }
  const share = Math.min(Math.max(net.sharp[h]! - level, 0), 1);
  for (let c = 0; c < n - 1; c++) {
    for (let x = 0; x < 3; x++) stepPoint(a, b, 3 * (n + c) + x, m + 6 * c + x, 3 * n, m, share, c > 0);
  }
  for (const [end, corner] of [h, after].entries()) {
    const ring = work.rings[1 - (level & 1)]![end]!;
    ringStep(net, net.corners[corner]!, level, work.rings[level & 1]![end]!, ring);
    putEnd(net, corner, end, ring, b, 2 * n - 1);
  }
}

/** Of the point at p, whose rows are of `row` words and become of m: the edge ahead, and if inside all else. */
function stepPoint(
  a: Float64Array,
  b: Float64Array,
  p: number,
  q: number,
  row: number,
  m: number,
  share: number,
  isInside: boolean,
): void {
  const both = a[p]! + a[p + 3]!;
  b[q + 3] = mixed(share, 0.5 * both, 0.25 * (both + (b[q + 3 + m]! + b[q + 3 - m]!)));
  if (!isInside) return;
  b[q - m] = 0.25 * (a[p - row]! + a[p]! + (b[q - m + 3]! + b[q - m - 3]!));
  b[q + m] = 0.25 * (a[p]! + a[p + row]! + (b[q + m + 3]! + b[q + m - 3]!));
  const edges = a[p + 3]! + a[p - 3]! + (a[p + row]! + a[p - row]!);
  const centres = b[q + m + 3]! + b[q - m - 3]! + (b[q - m + 3]! + b[q + m - 3]!);
  const crease = 0.75 * a[p]! + 0.125 * (a[p - 3]! + a[p + 3]!);
  b[q] = mixed(share, crease, 0.5 * a[p]! + 0.0625 * (edges + centres));
}

/** As far as it is sharp the one, else the other. */
function mixed(share: number, sharp: number, smooth: number): number {
  if (share === 0) return smooth;
  return share === 1 ? sharp : share * sharp + (1 - share) * smooth;
}
