/**
 * One step of Catmull and Clark's rules on any polygons, with those of DeRose, Kass and Truong for what is sharp.
 * It makes quadrangles of all faces: old vertices first, then one an edge, then one a face.
 *
 * @module refine/slates/firstStep
 */
import { NONE } from "./layout";
import { joined, type Polygons } from "./topology";

export interface FirstStep {
  readonly polygons: Polygons;
  /** Which face a quadrangle is of. */
  readonly faces: Int32Array;
  /** New rows of three of the old vertices' rows. */
  readonly points: (rows: Float64Array) => Float64Array;
}

export function firstStep(old: Polygons, name: string): FirstStep {
  const { count, starts, corners, edge, ends, previous, sharp } = old;
  const edges = ends.length / 2;
  const quads = new Int32Array(4 * corners.length);
  const faces = new Int32Array(corners.length);
  for (let f = 0; f + 1 < starts.length; f++) {
    for (let h = starts[f]!; h < starts[f + 1]!; h++) {
      faces[h] = f;
      quads.set([corners[h]!, count + edge[h]!, count + edges + f, count + edge[previous[h]!]!], 4 * h);
    }
  }
  const total = count + edges + starts.length - 1;
  const vertexSharp = new Float64Array(total);
  for (let v = 0; v < count; v++) vertexSharp[v] = Math.max(old.vertexSharp[v]! - 1, 0);
  const quadStarts = Int32Array.from({ length: corners.length + 1 }, (_, i) => 4 * i);
  const polygons = joined(total, quadStarts, quads, vertexSharp, name);
  for (let h = 0; h < quads.length; h++) {
    // Sides 0 and 3 of a quadrangle are halves of edges: that of its own corner, and of the one before.
    const own = h % 4 === 0 ? edge[h >> 2]! : h % 4 === 3 ? edge[previous[h >> 2]!]! : NONE;
    if (own !== NONE) polygons.sharp[polygons.edge[h]!] = Math.max(sharp[own]! - 1, 0);
  }
  const weights = weightsOf(old);
  return { polygons, faces, points: (rows) => stepped(old, weights, rows) };
}

/** Of each vertex: what is kept of it; of all around it; of its creases, and of those of the next step. */
interface Weights {
  readonly kept: Float64Array;
  readonly around: Float64Array;
  readonly now: Float64Array;
  readonly later: Float64Array;
}

const SMOOTH = 0;
const CREASE = 1;
const CORNER = 2;

function weightsOf({ count, ends, sharp, vertexSharp }: Polygons): Weights {
  const [valence, now, later] = [new Int32Array(count), new Int32Array(count), new Int32Array(count)];
  const [ending, total] = [new Int32Array(count), new Float64Array(count)];
  ends.forEach((v, i) => {
    const s = sharp[i >> 1]!;
    valence[v]!++;
    if (s > 0) now[v]!++;
    if (s > 1) later[v]!++;
    if (s > 0 && s <= 1) {
      ending[v]!++;
      total[v]! += s;
    }
  });
  const [kept, around] = [new Float64Array(count), new Float64Array(count)];
  const [creases, next] = [new Float64Array(count), new Float64Array(count)];
  for (let v = 0; v < count; v++) {
    const s = vertexSharp[v]!;
    const kind = kindOf(s > 0, now[v]!);
    const then = kindOf(s > 1, later[v]!);
    const isEnding = s > 0 && s <= 1;
    const mean = (total[v]! + (isEnding ? s : 0)) / Math.max(ending[v]! + (isEnding ? 1 : 0), 1);
    const share = kind === then ? 1 : Math.min(mean, 1);
    const of = (what: number) => (kind === what ? share : 0) + (then === what ? 1 - share : 0);
    const smooth = valence[v] === 0 ? 0 : of(SMOOTH); // a vertex of no face stays
    const inverse = 1 / Math.max(valence[v]!, 1);
    creases[v] = kind === CREASE ? share : 0;
    next[v] = then === CREASE ? 1 - share : 0;
    const sharpened = creases[v]! + next[v]!;
    kept[v] = smooth * (1 - 2 * inverse) + 0.75 * sharpened + (1 - smooth - sharpened);
    around[v] = smooth * inverse * inverse;
    creases[v]! /= 8;
    next[v]! /= 8;
  }
  return { kept, around, now: creases, later: next };
}

function kindOf(isCorner: boolean, sharp: number): number {
  return isCorner || sharp > 2 ? CORNER : sharp === 2 ? CREASE : SMOOTH;
}

function stepped(old: Polygons, weights: Weights, rows: Float64Array): Float64Array {
  const { count, starts, ends } = old;
  const edges = ends.length / 2;
  const out = new Float64Array(3 * (count + edges + starts.length - 1));
  for (let x = 0; x < 3; x++) {
    faceColumn(old, rows, out, x);
    edgeColumn(old, rows, out, x);
    vertexColumn(old, weights, rows, out, x);
  }
  return out;
}

function faceColumn(
  { count, starts, corners, ends }: Polygons,
  rows: Float64Array,
  out: Float64Array,
  x: number,
) {
  const base = 3 * (count + ends.length / 2) + x;
  for (let f = 0; f + 1 < starts.length; f++) {
    const size = starts[f + 1]! - starts[f]!;
    let total = 0;
    for (let h = starts[f]!; h < starts[f + 1]!; h++) total += (1 / size) * rows[3 * corners[h]! + x]!;
    out[base + 3 * f] = total;
  }
}

function edgeColumn(old: Polygons, rows: Float64Array, out: Float64Array, x: number) {
  const { count, starts, ends, edge, sharp } = old;
  const [base, centres] = [3 * count + x, 3 * (count + ends.length / 2) + x];
  for (let f = 0; f + 1 < starts.length; f++) {
    for (let h = starts[f]!; h < starts[f + 1]!; h++) {
      const share = 1 - Math.min(sharp[edge[h]!]!, 1);
      out[base + 3 * edge[h]!]! += share * 0.25 * out[centres + 3 * f]!;
    }
  }
  for (let e = 0; e < sharp.length; e++) {
    const share = Math.min(sharp[e]!, 1);
    const both = rows[3 * ends[2 * e]! + x]! + rows[3 * ends[2 * e + 1]! + x]!;
    out[base + 3 * e]! += (0.5 * share + 0.25 * (1 - share)) * both;
  }
}

function vertexColumn(old: Polygons, weights: Weights, rows: Float64Array, out: Float64Array, x: number) {
  const { count, starts, corners, ends, sharp } = old;
  const centres = 3 * (count + ends.length / 2) + x;
  for (let v = 0; v < count; v++) out[3 * v + x] = weights.kept[v]! * rows[3 * v + x]!;
  for (let i = 0; i < ends.length; i++) {
    const v = ends[i]!;
    const s = sharp[i >> 1]!;
    let weight = weights.around[v]!;
    if (s > 0) weight += weights.now[v]!;
    if (s > 1) weight += weights.later[v]!;
    out[3 * v + x]! += weight * rows[3 * ends[i ^ 1]! + x]!;
  }
  for (let f = 0; f + 1 < starts.length; f++) {
    for (let h = starts[f]!; h < starts[f + 1]!; h++) {
      const v = corners[h]!;
      out[3 * v + x]! += weights.around[v]! * out[centres + 3 * f]!;
    }
  }
}
