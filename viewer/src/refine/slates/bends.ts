/**
 * How much the surface bends at vertices, and how large patches are: once a control mesh.
 *
 * Based on: Settgast, Müller, Fünfzig, Fellner, section 3.1. Where the paper prints ln · n < cos alpha the cone is meant to
 * hold the normals, so it is >= here.
 *
 * @module refine/slates/bends
 */
import type { Limits } from "./limits";
import type { SlateNet } from "./net";
import { fillRing, ringStep } from "./ring";
import type { Work } from "./work";

/** Of each vertex and level, `levels` a vertex: the least cosine between its limit normal and its faces' normals. */
export function bends(net: SlateNet, work: Work, limits: Limits, levels: number): Float64Array {
  const out = new Float64Array(levels * net.fans.length).fill(1);
  for (let v = 0; v < net.fans.length; v++) {
    if (net.fans[v] === 0) continue;
    fillRing(net, limits.points, v, work.rings[0][0]!);
    for (let level = 0; level < levels; level++) {
      const ring = work.rings[level & 1]![0]!;
      out[levels * v + level] = leastCosine(net, limits.cornerNormals, v, ring);
      ringStep(net, v, level, ring, work.rings[1 - (level & 1)]![0]!);
    }
  }
  return out;
}

/** Each face's normal against that of its sector; a face without one does not bend. */
function leastCosine(net: SlateNet, normals: Float64Array, v: number, ring: Float64Array): number {
  const begin = net.fanStarts[v]!;
  const faces = net.fans[v]!;
  const spokes = net.ringStarts[v + 1]! - net.ringStarts[v]! - faces;
  let least = 1;
  for (let i = 0; i < faces; i++) {
    const e = 3 * (1 + i);
    const f = 3 * (1 + spokes + i);
    const g = 3 * (1 + ((i + 1) % spokes));
    const ax = ring[f]! - ring[0]!;
    const ay = ring[f + 1]! - ring[1]!;
    const az = ring[f + 2]! - ring[2]!;
    const bx = ring[g]! - ring[e]!;
    const by = ring[g + 1]! - ring[e + 1]!;
    const bz = ring[g + 2]! - ring[e + 2]!;
    const x = ay * bz - az * by;
    const y = az * bx - ax * bz;
    const z = ax * by - ay * bx;
    const length = Math.sqrt(x * x + y * y + z * z);
    if (!(length > 0)) continue;
    const at = 3 * net.normalOf[net.fan[begin + i]!]!;
    least = Math.min(least, (normals[at]! * x + normals[at + 1]! * y + normals[at + 2]! * z) / length);
  }
  return least;
}

/** Of each vertex the least level from which on, up to `most`, all normals are in the cone; else `most`. */
export function curvatureOf(cosines: Float64Array, levels: number, cone: number, most: number): Int8Array {
  const out = new Int8Array(cosines.length / levels);
  for (let v = 0; v < out.length; v++) {
    let level = most;
    const at = levels * v;
    while (level > 0 && cosines[at + level]! >= cone && cosines[at + level - 1]! >= cone) level--;
    out[v] = level;
  }
  return out;
}

/**
 * Centre and radius of a ball that holds the limit patch, of each patch.
 *
 * It holds all points a step further that the patch is a mean of, which are those of its corners' rings. The centre is
 * the corners' mean, so that a turned mesh has turned balls.
 */
export function ballsOf(net: SlateNet, work: Work, { points }: Limits): Float64Array {
  const { corners, fan, fanStarts, fans } = net;
  const out = new Float64Array(corners.length);
  for (let h = 0; h < out.length; h += 4) {
    for (let x = 0; x < 3; x++) {
      let total = 0;
      for (let k = 0; k < 4; k++) total += points[3 * corners[h + k]! + x]!;
      out[h + x] = 0.25 * total;
    }
  }
  const [before, ring] = [work.rings[0][0]!, work.rings[1][0]!];
  // Vertex by vertex, since a ring is that of several patches; which of them comes first does not change a maximum.
  for (let v = 0; v < fans.length; v++) {
    if (fans[v] === 0) continue;
    fillRing(net, points, v, before);
    ringStep(net, v, 0, before, ring);
    const words = 3 * (1 + net.ringStarts[v + 1]! - net.ringStarts[v]!);
    for (let i = fanStarts[v]!; i < fanStarts[v + 1]!; i++) reach(out, fan[i]! & ~3, ring, words);
  }
  for (let h = 3; h < out.length; h += 4) out[h] = Math.sqrt(out[h]!);
  return out;
}

/** Have the ball at h, whose radius is still a square, hold the points of a ring. */
function reach(balls: Float64Array, h: number, ring: Float64Array, words: number): void {
  let most = balls[h + 3]!;
  for (let i = 0; i < words; i += 3) {
    const x = ring[i]! - balls[h]!;
    const y = ring[i + 1]! - balls[h + 1]!;
    const z = ring[i + 2]! - balls[h + 2]!;
    most = Math.max(most, x * x + y * y + z * z);
  }
  balls[h + 3] = most;
}
