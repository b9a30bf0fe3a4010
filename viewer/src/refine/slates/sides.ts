/**
 * The sides of patches: their steps while sharp, and their limit points and normals.
 *
 * A side is seen from its patch: e_0 is ahead, e_1 inside, e_2 behind, e_3 outside; f_i between e_i and e_i+1. The patch
 * beyond sees the same with e_0 and e_2, e_1 and e_3 changed, and gets the same numbers.
 *
 * @module refine/slates/sides
 */
import { LIMIT_SHARE, WORDS } from "./layout";
import { putNormal, type Rows } from "./work";

/** Of side k of a table of n by n: words to its first corner. */
export function sideBegin(k: number, n: number): number {
  const row = n * WORDS;
  if (k === 0) return row + WORDS;
  if (k === 1) return row + (n - 2) * WORDS;
  return k === 2 ? (n - 2) * (row + WORDS) : (n - 2) * row + WORDS;
}

/** From point to point of it; inwards it is that of side k + 1. */
export function sideAhead(k: number, n: number): number {
  const row = n * WORDS;
  return k === 0 ? WORDS : k === 1 ? row : k === 2 ? -WORDS : -row;
}

export function sideInside(k: number, n: number): number {
  return sideAhead((k + 1) % 4, n);
}

/** The points of side k by the crease rule, as far as `share`; the rest is what stands there. */
export function sideStep(k: number, share: number, a: Float64Array, n: number, b: Float64Array): void {
  const [p, ahead] = [sideBegin(k, n), sideAhead(k, n)];
  const [q, onwards] = [sideBegin(k, 2 * n - 3), sideAhead(k, 2 * n - 3)];
  for (let i = 0; i < n - 3; i++) {
    for (let x = 0; x < 3; x++) {
      const here = p + i * ahead + x;
      const there = q + (2 * i + 1) * onwards + x;
      const middle = 0.5 * (a[here]! + a[here + ahead]!);
      b[there] = share === 1 ? middle : share * middle + (1 - share) * b[there]!;
      if (i === 0) continue;
      const point = 0.75 * a[here]! + 0.125 * (a[here - ahead]! + a[here + ahead]!);
      const old = there - onwards;
      b[old] = share === 1 ? point : share * point + (1 - share) * b[old]!;
    }
  }
}

/** Where the numbers of a side's point are, and how sharp the side still is. */
export interface SideRule {
  readonly ahead: number;
  readonly inside: number;
  readonly left: number;
  /** Row of `masks` while `left` is finite. */
  readonly masks: Float64Array;
  readonly at: number;
}

/** The limit point, the tangent ahead, the tangent inside: of x, y, z each. */
const scratch = new Float64Array(9);

/** Of one coordinate, whose points are at p. */
function applyRule(a: Float64Array, p: number, x: number, rule: SideRule): void {
  const { ahead, inside, left, masks, at } = rule;
  const [v, e0, e1, e2] = [a[p]!, a[p + ahead]!, a[p + inside]!, a[p - ahead]!];
  const [f0, f1] = [a[p + inside + ahead]!, a[p + inside - ahead]!];
  if (left === Infinity) {
    scratch[x] = (e0 + e2 + 4 * v) / 6;
    scratch[3 + x] = e0 - e2;
    scratch[6 + x] = 4 * (e1 - v) + (f0 + f1) - (e0 + e2);
    return;
  }
  const [e3, f2, f3] = [a[p - inside]!, a[p - inside - ahead]!, a[p - inside + ahead]!];
  const [along, across, diagonal] = [e0 + e2, e1 + e3, f0 + f2 + (f1 + f3)];
  const over = f0 + f3 - (f1 + f2);
  const inwards = f0 + f1 - (f2 + f3);
  if (left > 0) {
    scratch[x] =
      masks[at]! * v + masks[at + 3]! * diagonal + (masks[at + 1]! * along + masks[at + 2]! * across);
    scratch[3 + x] = masks[at + 4]! * (e0 - e2) + masks[at + 5]! * over;
    scratch[6 + x] = masks[at + 6]! * (e1 - e3) + masks[at + 7]! * inwards;
    return;
  }
  scratch[x] = (16 * v + 4 * (along + across) + diagonal) * LIMIT_SHARE;
  scratch[3 + x] = 4 * (e0 - e2) + over;
  scratch[6 + x] = 4 * (e1 - e3) + inwards;
}

/** Row o of positions and normals from the point at p. */
export function sidePoint(
  a: Float64Array,
  p: number,
  rule: SideRule,
  isSurface: boolean,
  out: Rows,
  o: number,
): void {
  const { positions, normals } = out;
  for (let x = 0; x < 3; x++) applyRule(a, p + x, x, rule);
  for (let x = 0; x < 3; x++) positions[3 * o + x] = scratch[x]!;
  if (!isSurface) return;
  putNormal(normals, o, scratch[3]!, scratch[4]!, scratch[5]!, scratch[6]!, scratch[7]!, scratch[8]!);
}
