/**
 * The inverses of √3 refinement's operators: flip an edge back, make one face of three.
 *
 * The same as `src/foveal/refine/_kernels_sqrt3_undo.py`.
 *
 * @module refine/undo
 */
import { isHalf, type Net, NONE, whole } from "./net";
import { cornerAt, giveFace, giveVertex, put, relink, setState, sew } from "./slots";

/** The inverse of a flip, for f = (w, c, b) and n = (x, b, c). */
function unflip(net: Net, f: number, n: number): void {
  const { corners, beside, around } = net;
  const w = corners[3 * f]!;
  const c = corners[3 * f + 1]!;
  const b = corners[3 * f + 2]!;
  const x = corners[3 * n]!;
  const f0 = beside[3 * f]!;
  const f2 = beside[3 * f + 2]!;
  const n0 = beside[3 * n]!;
  const n2 = beside[3 * n + 2]!;
  const state = net.states[f]! - 1;
  put(net, f, w, x, b, n, n0, f2, state);
  put(net, n, x, w, c, f, f0, n2, state);
  relink(net, n0, b, f);
  relink(net, f0, c, n);
  around[w] = f;
  around[x] = f;
  around[b] = f;
  around[c] = n;
}

/** Whether a face of the last generation is one of two that a flip made: its edge 1 is the new one. */
function isFlipped(net: Net, f: number): boolean {
  return net.births[net.corners[3 * f + 1]!] === net.births[net.corners[3 * f + 2]!];
}

/** A face at v that was a half, or NONE. */
function lastPromoted(net: Net, v: number): number {
  const { beside } = net;
  const state = whole(net.births[v]!);
  const first = net.around[v]!;
  for (let isBack = 0; isBack < 2; isBack++) {
    let f = first;
    while (f >= 0) {
      // The middle face of a cut border edge was none: its edge 1 is on the border.
      if (net.states[f] === state && !(isFlipped(net, f) && beside[3 * f + 1]! < 0)) return f;
      const k = cornerAt(net, f, v);
      f = beside[3 * f + (isBack ? k : (k + 2) % 3)]!;
      if (f === first) return NONE;
    }
  }
  return NONE;
}

/** Undo the flips around vertex v, and the promotion at a border: its faces are halves again. */
function unflipAll(net: Net, v: number): void {
  for (let f = lastPromoted(net, v); f !== NONE; f = lastPromoted(net, v)) {
    if (isFlipped(net, f)) unflip(net, f, net.beside[3 * f + 1]!);
    else setState(net, f, net.states[f]! - 1);
  }
}

/** Undo the split that made vertex v (and those with it), none of whose faces is split. */
export function unsplit(net: Net, v: number): void {
  const { corners, beside, triples, around } = net;
  unflipAll(net, v);
  const p = net.pairs[v]!;
  if (p !== NONE) {
    uncutAll(net, v, p);
    return;
  }
  const a = triples[3 * v]!;
  const b = triples[3 * v + 1]!;
  const c = triples[3 * v + 2]!;
  let f = around[v]!;
  while (corners[3 * f] !== a) f = beside[3 * f + 1]!;
  const g = beside[3 * f + 1]!;
  const h = beside[3 * g + 1]!;
  const n0 = beside[3 * f]!;
  const n1 = beside[3 * g]!;
  const n2 = beside[3 * h]!;
  put(net, f, a, b, c, n0, n1, n2, net.states[f]! - 1);
  relink(net, n1, c, f);
  relink(net, n2, a, f);
  around[a] = around[b] = around[c] = f;
  giveFace(net, g);
  giveFace(net, h);
  giveVertex(net, v);
}

/** Undo the cut of a border edge that made p and q, in either order, and at a seam that beyond. */
function uncutAll(net: Net, p: number, q: number): void {
  const t = net.twins[p]!;
  unflipAll(net, q);
  if (t === NONE) {
    uncut(net, p, q);
    return;
  }
  const u = net.pairs[t]!;
  unflipAll(net, t);
  unflipAll(net, u);
  const f = uncut(net, p, q);
  const n = uncut(net, t, u);
  sew(net, f, 0, n, 0);
}

/**
 * Make the three faces of a cut one again, their halves being unflipped; returns it.
 *
 * What is beyond its edge on the border is left to be said.
 */
function uncut(net: Net, p: number, q: number): number {
  const { corners, beside, triples, around } = net;
  const a = triples[3 * p]!;
  const b = triples[3 * p + 1]!;
  const c = triples[3 * p + 2]!;
  const level = net.births[p]! - 1;
  let f = around[p]!;
  const isAtApex = corners[3 * f] === c;
  const isMiddle = isAtApex && !isHalf(net.states[f]!);
  if (!isMiddle || (corners[3 * f + 1] !== p && corners[3 * f + 2] !== p)) {
    f = beside[3 * f + (isAtApex ? 2 : 1)]!;
  }
  const g = beside[3 * f]!;
  const h = beside[3 * f + 2]!;
  const n1 = beside[3 * h]!;
  const n2 = beside[3 * g]!;
  put(net, f, a, b, c, NONE, n1, n2, whole(level));
  relink(net, n1, c, f);
  relink(net, n2, a, f);
  around[a] = around[b] = around[c] = f;
  giveFace(net, g);
  giveFace(net, h);
  giveVertex(net, p);
  giveVertex(net, q);
  return f;
}
