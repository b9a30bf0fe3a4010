/**
 * Limits and normals of vertices of a √3 refinement, from their rings on the level of their birth.
 *
 * They are asked for only when a face at the vertex is to be split, which two in three vertices never see. The same
 * as `src/foveal/refine/_kernels_sqrt3_measure.py`, with its order of the arithmetic.
 *
 * @module refine/measure
 */
import {
  generation,
  half,
  INSIDE,
  LATE,
  LIMIT,
  type Net,
  NONE,
  POINT,
  THIRD_VECTOR,
  UNMEASURED,
} from "./net";
import { nearPoint, position, THIRD, virtualApex } from "./points";
import { cornerAt } from "./slots";

const HALF_ROOT3 = 0.8660254037844386;

/** Cosines and sines of the sixths of a turn. */
const COSINES = [1, 0.5, -0.5, -1, -0.5, 0.5];
const SINES = [0, HALF_ROOT3, HALF_ROOT3, 0, -HALF_ROOT3, -HALF_ROOT3];

/** (4 - 2 cos(2 pi / n)) / 9 for n = 3, 4, 5: written out, since cosines differ between machines. */
const LATE_SHARES = [0, 0, 0, 5 / 9, 4 / 9, 0.3757740012500117];

/** Of the ring being gathered: its sum, its two tangents. */
const SUMS = new Float64Array(9);

/** A point of the ring; the points from which one is made; where the vertex itself is. */
const ITEM = new Float64Array(3);
const ENDS = new Float64Array(6);
const OWN = new Float64Array(3);

/** Measure the corners born with the face f, before it is split: then their rings are still at hand. */
export function measureCorners(net: Net, f: number): void {
  const level = generation(net.states[f]!);
  for (let k = 3 * f; k < 3 * f + 3; k++) {
    const v = net.corners[k]!;
    if (net.births[v] === level && net.kinds[v] === UNMEASURED) measure(net, v);
  }
}

/** The face at v in which u follows v: the half of v's birth face from u, or its flipped part there. */
function partAt(net: Net, v: number, u: number): number {
  let f = net.around[v]!;
  for (let i = 0; i < 6; i++) {
    const k = cornerAt(net, f, v);
    if (net.corners[3 * f + ((k + 1) % 3)] === u) return f;
    f = net.beside[3 * f + ((k + 2) % 3)]!;
  }
  return f;
}

/**
 * Write to ITEM what follows corner u in the ring of vertex b on the level of its birth.
 *
 * What begins at u around b is the half (u, next, b), its flipped part (u, apex, b), or a border's face: then the
 * next corner is returned and nothing written, else NONE.
 */
function beyond(net: Net, b: number, u: number): number {
  const level = net.births[b]!;
  const f = partAt(net, b, u);
  if (net.states[f] === half(level - 1)) {
    virtualApex(net, f, ITEM, 0);
    return NONE;
  }
  const c = net.corners[3 * f + 1]!;
  const isAtBorder = net.beside[3 * f]! < 0 && net.corners[3 * f + 2] === b;
  if (isAtBorder && net.births[c] !== level) return c;
  for (let k = 0; k < 3; k++) ITEM[k] = net.points[POINT * c + k]!;
  return NONE;
}

/** Add what is in ITEM, vertex i of a ring of six. */
function gather(i: number): void {
  const s = COSINES[i]!;
  const t = SINES[i]!;
  for (let k = 0; k < 3; k++) {
    const x = ITEM[k]!;
    SUMS[k]! += x;
    SUMS[3 + k]! += s * x;
    SUMS[6 + k]! += t * x;
  }
}

/** The limit and normal of vertex b, none of whose faces is finer than itself; on a border it is LATE. */
export function measure(net: Net, b: number): void {
  const { points, triples } = net;
  const level = net.births[b]!;
  const p = POINT * b;
  SUMS.fill(0);
  let borders = 0;
  for (let i = 0; i < 3; i++) {
    const u = triples[3 * b + i]!;
    position(net, u, level, ITEM, 0);
    gather(2 * i);
    if (beyond(net, b, u) === NONE) gather(2 * i + 1);
    else borders++;
  }
  for (let k = 0; k < 3; k++) OWN[k] = points[p + k]!;
  net.kinds[b] = INSIDE;
  if (borders > 0) {
    const share = LATE_SHARES[6 - borders]!;
    for (let k = 0; k < 3; k++) {
      OWN[k] = (1 - share) * OWN[k]! + (share * SUMS[k]!) / (6 - borders);
      points[p + THIRD_VECTOR + k] = OWN[k]!;
    }
    net.kinds[b] = LATE;
    laterRing(net, b);
  }
  for (let k = 0; k < 3; k++) points[p + LIMIT + k] = 0.5 * (OWN[k]! + SUMS[k]! / 6);
  ringNormal(net, b);
}

/** Gather the ring of vertex b one level after its birth, when it has grown to six. */
function laterRing(net: Net, b: number): void {
  const { points, triples } = net;
  const level = net.births[b]!;
  const p = POINT * b;
  SUMS.fill(0);
  for (let i = 0; i < 3; i++) {
    const u = triples[3 * b + i]!;
    const w = triples[3 * b + ((i + 1) % 3)]!;
    const end = beyond(net, b, u);
    if (end !== NONE) {
      // a border edge follows, which is cut in three
      nearPoint(net, u, end, level, true, ITEM, 0);
      gather(2 * i);
      nearPoint(net, u, end, level, false, ITEM, 0);
      gather(2 * i + 1);
      continue;
    }
    position(net, u, level, ENDS, 0);
    position(net, w, level, ENDS, 3);
    const x = ITEM[0]!;
    const y = ITEM[1]!;
    const z = ITEM[2]!;
    ITEM[0] = (points[p]! + ENDS[0]! + x) * THIRD;
    ITEM[1] = (points[p + 1]! + ENDS[1]! + y) * THIRD;
    ITEM[2] = (points[p + 2]! + ENDS[2]! + z) * THIRD;
    gather(2 * i);
    ITEM[0] = (points[p]! + x + ENDS[3]!) * THIRD;
    ITEM[1] = (points[p + 1]! + y + ENDS[4]!) * THIRD;
    ITEM[2] = (points[p + 2]! + z + ENDS[5]!) * THIRD;
    gather(2 * i + 1);
  }
}

/** The normal of the limit surface at a vertex of valence six, by its ring's tangents. */
function ringNormal(net: Net, v: number): void {
  const sx = SUMS[3]!;
  const sy = SUMS[4]!;
  const sz = SUMS[5]!;
  const tx = SUMS[6]!;
  const ty = SUMS[7]!;
  const tz = SUMS[8]!;
  setNormal(net, v, sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx);
}

/** The unit vector along (x, y, z); zero where that is none. */
export function setNormal(net: Net, v: number, x: number, y: number, z: number): void {
  const length = Math.sqrt(x * x + y * y + z * z);
  const scale = length > 0 ? 1 / length : 0;
  net.normals[3 * v] = x * scale;
  net.normals[3 * v + 1] = y * scale;
  net.normals[3 * v + 2] = z * scale;
}
