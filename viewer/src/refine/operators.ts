/**
 * Local operators of √3 refinement: split a face, flip an edge.
 *
 * The same as `src/foveal/refine/_kernels_sqrt3.py`, with its order of the arithmetic.
 *
 * Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000.
 *
 * @module refine/operators
 */
import { measureCorners } from "./measure";
import {
  BORDER,
  beyondSeam,
  generation,
  half,
  LIMIT,
  type Net,
  NONE,
  PARENT,
  POINT,
  THIRD_VECTOR,
  UNMEASURED,
  whole,
} from "./net";
import { middle, nearPoint, position } from "./points";
import { put, relink, setState, sew, takeFace, takeVertex } from "./slots";

/**
 * Two halves of one old edge (w, x) become two faces of the next generation: half h = (w, x, b) becomes (w, c, b),
 * its mate n = (x, w, c) becomes (x, b, c).
 */
function flip(net: Net, h: number, n: number): void {
  const { corners, beside, around } = net;
  const w = corners[3 * h]!;
  const x = corners[3 * h + 1]!;
  const b = corners[3 * h + 2]!;
  const c = corners[3 * n + 2]!;
  const h1 = beside[3 * h + 1]!;
  const h2 = beside[3 * h + 2]!;
  const n1 = beside[3 * n + 1]!;
  const n2 = beside[3 * n + 2]!;
  const state = net.states[h]! + 1;
  put(net, h, w, c, b, n1, n, h2, state);
  put(net, n, x, b, c, h1, h, n2, state);
  relink(net, n1, c, h);
  relink(net, h1, b, n);
  around[w] = h;
  around[x] = n;
  around[b] = h;
  around[c] = h;
}

/** A new half becomes a face of the next generation, if nothing is beyond its old edge or a half is. */
function settle(net: Net, h: number): void {
  const n = net.beside[3 * h]!;
  const state = net.states[h]!;
  if (n < 0) setState(net, h, state + 1);
  else if (net.states[n] === state && net.beside[3 * n] === h) flip(net, h, n);
}

/** Flags that say which corners of a face are of its own generation. */
function parents(net: Net, u: number, v: number, w: number, level: number): number {
  if (level === 0) return 0;
  const { births } = net;
  return (
    (births[u] === level ? PARENT : 0) |
    (births[v] === level ? 2 * PARENT : 0) |
    (births[w] === level ? 4 * PARENT : 0)
  );
}

/** A new vertex, of the face a, b, c of a level; its flags say but its parents. */
function born(net: Net, a: number, b: number, c: number, pair: number, level: number, kind: number): number {
  const v = takeVertex(net);
  net.triples[3 * v] = a;
  net.triples[3 * v + 1] = b;
  net.triples[3 * v + 2] = c;
  net.pairs[v] = pair;
  net.twins[v] = NONE;
  net.kinds[v] = kind;
  net.births[v] = level + 1;
  net.flags[v] = parents(net, a, b, c, level);
  return v;
}

/** Split a face of generation k that is not to be cut at a seam; returns the new vertex, or the first of two. */
export function split(net: Net, f: number): number {
  const { corners, beside, around } = net;
  const level = generation(net.states[f]!);
  if (level % 2 === 1 && beside[3 * f]! < 0) {
    const p = cut(net, f);
    settleCut(net, f);
    return p;
  }
  const u = corners[3 * f]!;
  const v = corners[3 * f + 1]!;
  const w = corners[3 * f + 2]!;
  if (level > 0) measureCorners(net, f);
  const n0 = beside[3 * f]!;
  const n1 = beside[3 * f + 1]!;
  const n2 = beside[3 * f + 2]!;
  const b = born(net, u, v, w, NONE, level, UNMEASURED);
  middle(net, f, level, net.points, POINT * b);
  net.points[POINT * b + LIMIT] = NaN; // unmeasured: whoever reads it would show
  const g = takeFace(net);
  const h = takeFace(net);
  put(net, f, u, v, b, n0, g, h, half(level));
  put(net, g, v, w, b, n1, h, f, half(level));
  put(net, h, w, u, b, n2, f, g, half(level));
  relink(net, n1, w, g);
  relink(net, n2, u, h);
  around[u] = f;
  around[v] = g;
  around[w] = h;
  around[b] = f;
  settle(net, f);
  settle(net, g);
  settle(net, h);
  return b;
}

/** The face beyond the seam at which face f is to be cut, or NONE if there is none. */
export function beyondCut(net: Net, f: number): number {
  const word = net.beside[3 * f]!;
  return word < NONE && generation(net.states[f]!) % 2 === 1 ? Math.floor(beyondSeam(word) / 3) : NONE;
}

/** Split the two faces of an odd generation at a seam; returns the first new vertex of f. */
export function cutSeam(net: Net, f: number, n: number): number {
  const { pairs, twins, beside } = net;
  const p = cut(net, f);
  const r = cut(net, n);
  const q = pairs[p]!;
  const s = pairs[r]!;
  twins[p] = s;
  twins[s] = p;
  twins[q] = r;
  twins[r] = q;
  sew(net, f, 1, n, 1);
  sew(net, beside[3 * f]!, 1, beside[3 * n + 2]!, 2);
  sew(net, beside[3 * f + 2]!, 2, beside[3 * n]!, 1);
  settleCut(net, f);
  settleCut(net, n);
  return p;
}

/** Settle the halves on both sides of the middle face f of a cut. */
function settleCut(net: Net, f: number): void {
  const g = net.beside[3 * f]!;
  const h = net.beside[3 * f + 2]!;
  settle(net, g);
  settle(net, h);
}

/** The points of a border edge that is cut: its ends, on the next level, with the two new ones between. */
const LINE = new Float64Array(12);

/**
 * Split a face of odd generation, in three from its border edge; returns the first new vertex.
 *
 * What is beyond the three edges on the border is left to be said, and the two halves to be settled.
 */
function cut(net: Net, f: number): number {
  const { corners, beside, normals, around } = net;
  const level = generation(net.states[f]!);
  const a = corners[3 * f]!;
  const b = corners[3 * f + 1]!;
  const c = corners[3 * f + 2]!;
  measureCorners(net, f);
  const n1 = beside[3 * f + 1]!;
  const n2 = beside[3 * f + 2]!;
  position(net, a, level + 1, LINE, 0);
  nearPoint(net, a, b, level, true, LINE, 3);
  nearPoint(net, a, b, level, false, LINE, 6);
  position(net, b, level + 1, LINE, 9);
  const p = born(net, a, b, c, NONE, level, BORDER);
  const q = born(net, a, b, c, p, level, BORDER);
  net.pairs[p] = q;
  putBorderPoint(net, p, 0);
  putBorderPoint(net, q, 3);
  for (let k = 0; k < 3; k++) normals[3 * p + k] = normals[3 * q + k] = normals[3 * c + k]!;
  const g = takeFace(net);
  const h = takeFace(net);
  put(net, f, c, p, q, g, NONE, h, whole(level + 1));
  put(net, g, c, a, p, n2, NONE, f, half(level));
  put(net, h, b, c, q, n1, f, NONE, half(level));
  relink(net, n1, c, h);
  relink(net, n2, a, g);
  around[a] = g;
  around[b] = h;
  around[c] = around[p] = around[q] = f;
  return p;
}

/** The three vectors of border vertex v, whose neighbour before, self and neighbour after lie in LINE from `at`. */
function putBorderPoint(net: Net, v: number, at: number): void {
  const { points } = net;
  for (let k = 0; k < 3; k++) {
    const before = LINE[at + k]!;
    const x = LINE[at + 3 + k]!;
    const after = LINE[at + 6 + k]!;
    const p = POINT * v + k;
    points[p] = x;
    points[p + LIMIT] = after - before;
    points[p + THIRD_VECTOR] = before + after - 2 * x;
  }
}
