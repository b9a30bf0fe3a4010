/**
 * Where the vertices of uniform √3 subdivision are at every level, without subdividing.
 *
 * A vertex has three vectors, and its kind says which:
 *
 * - INSIDE: where it was born, its limit;
 * - LATE (born in a face with a border edge; its ring grows on the step after): where it was born, its limit, where
 *   it is one level later;
 * - BORDER: where it was born, next - previous border vertex, previous + next - 2 itself;
 * - CORNER: twice where it stays.
 *
 * The two sides of a seam run opposite ways, and are to agree in every bit: what is summed along a border is summed in
 * an order that does not say which way it runs.
 *
 * All functions write three doubles at `at` of `out`, and allocate nothing. The order of the arithmetic is that of
 * `src/foveal/refine/_kernels_sqrt3_points.py`, so that results agree to the last bit.
 *
 * Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000, with its border rule (every second step).
 *
 * @module refine/points
 */
import { BORDER, CORNER, generation, isHalf, LATE, LIMIT, type Net, POINT, THIRD_VECTOR } from "./net";

export const THIRD = 1 / 3;
const NINTH = 1 / 9;

/** Vertex v on a level not below its birth. */
export function position(net: Net, v: number, level: number, out: Float64Array, at: number): void {
  const { points } = net;
  const birth = net.births[v]!;
  const kind = net.kinds[v]!;
  let p = POINT * v;
  let steps = level - birth;
  if (steps === 0) {
    out[at] = points[p]!;
    out[at + 1] = points[p + 1]!;
    out[at + 2] = points[p + 2]!;
    return;
  }
  if (kind === BORDER) {
    borderPosition(points, p, steps, out, at);
    return;
  }
  const l = p + LIMIT;
  if (kind === LATE) {
    p += THIRD_VECTOR;
    steps--;
  }
  const shrink = birth === 0 ? net.shrinks[v]! : THIRD;
  let share = 1;
  for (let i = 0; i < steps; i++) share *= shrink;
  const lx = points[l]!;
  const ly = points[l + 1]!;
  const lz = points[l + 2]!;
  out[at] = lx + share * (points[p]! - lx);
  out[at + 1] = ly + share * (points[p + 1]! - ly);
  out[at + 2] = lz + share * (points[p + 2]! - lz);
}

function borderPosition(points: Float64Array, p: number, steps: number, out: Float64Array, at: number): void {
  let share = 1;
  for (let i = steps >> 1; i > 0; i--) share *= NINTH; // the border stands still on every other step
  share = (1 - share) / 6;
  for (let k = 0; k < 3; k++) out[at + k] = points[p + k]! + share * points[p + THIRD_VECTOR + k]!;
}

/** The border vertex after, or before, v on a level; v as in `position`. */
function borderNeighbour(
  net: Net,
  v: number,
  level: number,
  isNext: boolean,
  out: Float64Array,
  at: number,
): void {
  const { points } = net;
  let near = 1;
  let far = 1;
  for (let i = (level - net.births[v]!) >> 1; i > 0; i--) {
    near *= THIRD;
    far *= NINTH;
  }
  if (!isNext) near = -near;
  const bend = (1 - far) / 6 + 0.5 * far;
  near *= 0.5;
  const p = POINT * v;
  for (let k = 0; k < 3; k++) {
    out[at + k] = points[p + k]! + bend * points[p + THIRD_VECTOR + k]! + near * points[p + LIMIT + k]!;
  }
}

const EDGE = new Float64Array(9);

/** The new point near a (isFirst), or near b, of the border edge a, b that is cut on an odd level. */
export function nearPoint(
  net: Net,
  a: number,
  b: number,
  level: number,
  isFirst: boolean,
  out: Float64Array,
  at: number,
): void {
  const v = isFirst ? a : b;
  position(net, v, level, EDGE, 0);
  position(net, isFirst ? b : a, level, EDGE, 3);
  if (net.kinds[v] === CORNER) {
    // as if the edge went straight on beyond it
    for (let k = 0; k < 3; k++) out[at + k] = (EDGE[k]! + EDGE[k]! + EDGE[3 + k]!) * THIRD;
    return;
  }
  borderNeighbour(net, v, level, !isFirst, EDGE, 6);
  for (let k = 0; k < 3; k++) out[at + k] = (EDGE[6 + k]! + 16 * EDGE[k]! + 10 * EDGE[3 + k]!) / 27;
}

const CORNERS = new Float64Array(9);

/** The barycentre of face f on its level; the face's first corner is first in the sum. */
export function middle(net: Net, f: number, level: number, out: Float64Array, at: number): void {
  const { corners } = net;
  position(net, corners[3 * f]!, level, CORNERS, 0);
  position(net, corners[3 * f + 1]!, level, CORNERS, 3);
  position(net, corners[3 * f + 2]!, level, CORNERS, 6);
  out[at] = (CORNERS[0]! + CORNERS[3]! + CORNERS[6]!) * THIRD;
  out[at + 1] = (CORNERS[1]! + CORNERS[4]! + CORNERS[7]!) * THIRD;
  out[at + 2] = (CORNERS[2]! + CORNERS[5]! + CORNERS[8]!) * THIRD;
}

/**
 * The vertex that would face half h, of generation k, once its mate is split.
 *
 * The mate is a face of generation k, or would be: then the half of generation k - 1 that is there instead has a
 * virtual apex of its own, and so on.
 */
export function virtualApex(net: Net, h: number, out: Float64Array, at: number): void {
  const { beside, states } = net;
  const n = beside[3 * h]!;
  if (!isHalf(states[n]!)) {
    apexInFace(net, h, n, out, at);
    return;
  }
  virtualApex(net, n, out, at);
  apexInHalf(net, h, n, out, at);
}

/** The virtual apex of half h, whose mate is the face n. */
function apexInFace(net: Net, h: number, n: number, out: Float64Array, at: number): void {
  const { corners, beside } = net;
  const level = generation(net.states[h]!);
  if (level % 2 === 0 || beside[3 * n]! >= 0) {
    middle(net, n, level, out, at);
    return;
  }
  // The face will be cut at its border, its edge 0. Beside its edge 2, which ends at the border's first:
  const isFirst = corners[3 * n + 2] === corners[3 * h + 1];
  nearPoint(net, corners[3 * n]!, corners[3 * n + 1]!, level, isFirst, out, at);
}

/**
 * The virtual apex of half h; in place of its mate is half n, whose own virtual apex is in `out`, and is replaced.
 *
 * The two faces that n is to be part of are (first vertex, apex, new vertex), (second vertex, new vertex, apex).
 */
function apexInHalf(net: Net, h: number, n: number, out: Float64Array, at: number): void {
  const { corners } = net;
  const level = generation(net.states[h]!);
  // beside its edge 2, from the new vertex to the first
  const isFirst = corners[3 * n + 2] === corners[3 * h + 1];
  position(net, corners[3 * n + (isFirst ? 0 : 1)]!, level, CORNERS, 0);
  position(net, corners[3 * n + 2]!, level, CORNERS, 3);
  for (let k = 0; k < 3; k++) {
    const v = CORNERS[k]!;
    const c = CORNERS[3 + k]!;
    const d = out[at + k]!;
    out[at + k] = (isFirst ? v + d + c : v + c + d) * THIRD;
  }
}
