/** Slots of a √3 refinement: taking, freeing, writing faces; and the queue of faces to be asked. */
import { beyondSeam, FREE, type Net, NONE, seam } from "./net";

/** A free face slot. */
export function takeFace(net: Net): number {
  if (net.freeFaces === 0) return net.faceSlots++;
  const f = net.freeFace;
  net.freeFaces--;
  net.freeFace = net.beside[3 * f]!;
  return f;
}

/** A free vertex slot. */
export function takeVertex(net: Net): number {
  if (net.freeVertices === 0) return net.vertexSlots++;
  const v = net.freeVertex;
  net.freeVertices--;
  net.freeVertex = net.triples[3 * v]!;
  return v;
}

export function giveFace(net: Net, f: number): void {
  net.states[f] = FREE;
  net.beside[3 * f] = net.freeFace;
  net.freeFace = f;
  net.freeFaces++;
}

export function giveVertex(net: Net, v: number): void {
  net.births[v] = FREE;
  net.triples[3 * v] = net.freeVertex;
  net.freeVertex = v;
  net.freeVertices++;
}

/** Let a face be asked, unless it waits already. */
export function enqueue(net: Net, f: number): void {
  if (net.isQueued[f]) return;
  net.isQueued[f] = 1;
  const i = net.first + net.queued;
  const { queue } = net;
  queue[i < queue.length ? i : i - queue.length] = f;
  net.queued++;
}

/** The face that has waited longest. */
export function dequeue(net: Net): number {
  const i = net.first;
  const f = net.queue[i]!;
  net.first = i + 1 < net.queue.length ? i + 1 : 0;
  net.queued--;
  net.isQueued[f] = 0;
  return f;
}

/** Write a face: corners, faces beyond, state; it is to be asked. */
export function put(
  net: Net,
  f: number,
  a: number,
  b: number,
  c: number,
  x: number,
  y: number,
  z: number,
  state: number,
): void {
  const { corners, beside } = net;
  const i = 3 * f;
  corners[i] = a;
  corners[i + 1] = b;
  corners[i + 2] = c;
  beside[i] = x;
  beside[i + 1] = y;
  beside[i + 2] = z;
  if (Math.min(x, y, z) < NONE) tellBeyond(net, f);
  setState(net, f, state);
}

/** Tell the faces beyond the seams of face f where it is. */
function tellBeyond(net: Net, f: number): void {
  const { beside } = net;
  for (let k = 0; k < 3; k++) {
    const word = beside[3 * f + k]!;
    if (word < NONE) beside[beyondSeam(word)] = seam(f, k);
  }
}

/** Edge j of face f and edge k of face n are the two sides of a seam. */
export function sew(net: Net, f: number, j: number, n: number, k: number): void {
  net.beside[3 * f + j] = seam(n, k);
  net.beside[3 * n + k] = seam(f, j);
}

/** Make a face another kind; it is to be asked. */
export function setState(net: Net, f: number, state: number): void {
  net.states[f] = state;
  net.faceUntil[f] = 0;
  enqueue(net, f);
}

/** Tell face n, if it is one, that f is beyond its edge that begins at u. */
export function relink(net: Net, n: number, u: number, f: number): void {
  if (n >= 0) net.beside[3 * n + cornerAt(net, n, u)] = f;
}

/** Which corner of face f vertex v is. */
export function cornerAt(net: { readonly corners: Int32Array }, f: number, v: number): number {
  const { corners } = net;
  return corners[3 * f] === v ? 0 : corners[3 * f + 1] === v ? 1 : 2;
}
