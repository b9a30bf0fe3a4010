/**
 * Which faces of a √3 refinement are split for a view, and bringing the mesh there from wherever it is.
 *
 * - A face is wanted split if it meets the criteria and one of its parents (the split faces that its newest corners
 *   are from) is wanted. It is needed split if it is wanted, or parent of a needed one, or beside a wanted one whose
 *   third at their edge meets the criteria. All this reads positions of uniform subdivision only; so the mesh depends
 *   on the view, not on the way to it.
 * - Answers are kept with their slack: `drift` is how far the eye and the frustum moved in all since the beginning,
 *   and a face's and a vertex's `until` say up to which drift an answer holds.
 *
 * The same mesh as `src/foveal/refine/_kernels_sqrt3_update.py` makes, which looks at less: it knows the children of
 * vertices, keeps answers by two counts and asks no half anew that was a flipped face.
 *
 * @module refine/update
 */
import {
  type Asked,
  examine,
  examineHalf,
  isSeenBeyond,
  meets,
  ROUNDED,
  UNTIL,
  wasWantedByParent,
} from "./ask";
import { FREE, isHalf, MAX_LEVEL, MEETS, NEEDED, type Net, NONE, PARENT, PARENTS, WANTED } from "./net";
import { beyondCut, cutSeam, split } from "./operators";
import { cornerAt, dequeue, enqueue } from "./slots";
import { unsplit } from "./undo";
import { SLACK } from "./wanted";

/**
 * Slots that a single examination may use: forced splits go down through the generations. Along a seam also the face
 * beyond may be behind, and what it waits for: there a single split is asked for at a time.
 */
const ROOM = 512;
const LITTLE_ROOM = 8;

/** The vertices born after level 0, by birth. */
function sortedByBirth(net: Net): Int32Array {
  const { births, vertexSlots } = net;
  const starts = new Int32Array(MAX_LEVEL + 3);
  for (let v = 0; v < vertexSlots; v++) if (births[v]! > 0) starts[births[v]! + 1]!++;
  for (let i = 1; i < starts.length; i++) starts[i]! += starts[i - 1]!;
  const order = new Int32Array(starts[starts.length - 1]!);
  for (let v = 0; v < vertexSlots; v++) if (births[v]! > 0) order[starts[births[v]!]!++] = v;
  return order;
}

/** Set WANTED anew for the vertices of `order`, by rising birth, then NEEDED from last to first. */
function review(net: Net, order: Int32Array, asked: Asked): void {
  const { flags, twins } = net;
  for (const v of order) {
    const next = reviewed(net, v, asked);
    if ((next & ~flags[v]! & WANTED) !== 0) wake(net, v);
    flags[v] = next;
  }
  for (let i = order.length - 1; i >= 0; i--) {
    const v = order[i]!;
    if ((flags[v]! & (WANTED | NEEDED)) === 0) {
      if (!isSeenBeyond(net, v, asked)) continue;
      need(net, v);
    }
    needParents(net, v);
    const twin = twins[v]!;
    if (twin === NONE) continue;
    need(net, twin); // wanted on one side of a seam only, it may have come after
    needParents(net, twin);
  }
}

/** Keep the splits of which the birth face of vertex v is made. */
function needParents(net: Net, v: number): void {
  const own = net.flags[v]!;
  for (let k = 0; k < 3; k++) if ((own & (PARENT << k)) !== 0) need(net, net.triples[3 * v + k]!);
}

/** Keep the split that made vertex v, and at a seam that beyond. */
function need({ flags, pairs, twins }: Net, v: number): void {
  flags[v]! |= NEEDED;
  const p = pairs[v]!;
  const t = twins[v]!;
  if (p !== NONE) flags[p]! |= NEEDED;
  if (t === NONE) return;
  flags[t]! |= NEEDED;
  flags[pairs[t]!]! |= NEEDED;
}

/** Flags of vertex v for what is asked, without NEEDED. */
function reviewed(net: Net, v: number, asked: Asked): number {
  let flags = net.flags[v]! & (MEETS | PARENTS);
  if (!wasWantedByParent(net, v)) return flags;
  if (net.vertexUntil[v]! <= asked.drift) {
    const { triples } = net;
    const level = net.births[v]! - 1;
    const isMet = meets(net, triples[3 * v]!, triples[3 * v + 1]!, triples[3 * v + 2]!, level, asked);
    flags = (flags & PARENTS) | (isMet ? MEETS : 0);
    net.vertexUntil[v] = (asked.drift + SLACK[0]!) * ROUNDED;
  }
  return (flags & MEETS) !== 0 ? flags | WANTED : flags;
}

/** Let the faces at v be asked that were not, since they had no wanted parent. */
function wake(net: Net, v: number): void {
  const { beside, faceUntil } = net;
  const first = net.around[v]!;
  for (let isBack = 0; isBack < 2; isBack++) {
    let f = first;
    while (f >= 0) {
      if (faceUntil[f] === Infinity) {
        faceUntil[f] = 0;
        enqueue(net, f);
      }
      const k = cornerAt(net, f, v);
      f = beside[3 * f + (isBack ? k : (k + 2) % 3)]!;
      if (f === first) return;
    }
  }
}

/** Undo what is not needed, finest first, and let faces wait that have to be asked; returns how many splits. */
export function coarsen(net: Net, asked: Asked): number {
  const order = sortedByBirth(net);
  review(net, order, asked);
  let undone = 0;
  for (let i = order.length - 1; i >= 0; i--) {
    const v = order[i]!;
    if ((net.flags[v]! & (WANTED | NEEDED)) === 0 && net.births[v] !== FREE) {
      unsplit(net, v);
      undone++;
    }
  }
  const { faceSlots, faceUntil, states } = net;
  for (let f = 0; f < faceSlots; f++) {
    if (faceUntil[f]! <= asked.drift && states[f] !== FREE) enqueue(net, f);
  }
  return undone;
}

/**
 * Split face f, which is wanted itself (isOwn, UNTIL which drift) or only needed.
 *
 * Where it is cut at a seam, the face beyond is split with it.
 */
function splitAs(net: Net, f: number, isOwn: boolean, asked: Asked): void {
  const until = UNTIL[0]!;
  const n = beyondCut(net, f);
  if (n === NONE) {
    mark(net, split(net, f), isOwn, until);
    return;
  }
  const isOther = examine(net, n, asked);
  const other = UNTIL[0]!;
  const p = cutSeam(net, f, n);
  mark(net, p, isOwn, until);
  mark(net, net.twins[p]!, isOther, other);
}

/** Say of a new vertex, and its pair, whether its birth face was wanted split itself. */
function mark({ flags, vertexUntil, pairs }: Net, b: number, isOwn: boolean, until: number): void {
  flags[b]! |= isOwn ? MEETS | WANTED : NEEDED;
  vertexUntil[b] = isOwn ? until : 0;
  const c = pairs[b]!;
  if (c === NONE) return;
  flags[c] = flags[b]!;
  vertexUntil[c] = vertexUntil[b]!;
}

function makeRoom(net: Net, room: number): void {
  if (net.faceSlots + room > net.states.length || net.vertexSlots + room > net.births.length) net.grow();
}

/**
 * Split what is wanted, beginning with the faces in the queue, until there are `most` vertices.
 *
 * First in, first out: so most mates are split when a half's turn comes, and need not be imagined.
 */
export function refine(net: Net, most: number, asked: Asked): void {
  while (net.queued > 0 && net.vertices < most) {
    makeRoom(net, ROOM);
    const f = dequeue(net);
    const state = net.states[f]!;
    if (state === FREE || net.faceUntil[f]! > asked.drift) continue;
    const isOwn = isHalf(state) ? examineHalf(net, f, asked) : examine(net, f, asked);
    if (!isOwn) net.faceUntil[f] = UNTIL[0]!;
    else if (waitsFor(net, f) === NONE) splitAs(net, f, true, asked);
    else force(net, f, asked);
  }
}

/**
 * What is to be split, or if a half to become a face, before f is; or NONE.
 *
 * A half waits for its mate, or the half of the last generation in its place; a face to be cut at a seam for that
 * beyond, which may be the face before the last split, or still a half of the cut before that.
 */
function waitsFor(net: Net, f: number): number {
  const state = net.states[f]!;
  if (isHalf(state)) return net.beside[3 * f]!;
  const n = beyondCut(net, f);
  return n !== NONE && net.states[n] !== state ? n : NONE;
}

/** What waits for the next, and the state it had. */
const CHAIN = new Int32Array(2 * MAX_LEVEL + 2);
const STATES = new Int8Array(2 * MAX_LEVEL + 2);

/** Split face f, or make half f a face by splitting its mate, and first what they wait for. */
function force(net: Net, f: number, asked: Asked): void {
  let depth = 1;
  CHAIN[0] = f;
  STATES[0] = net.states[f]!;
  while (depth > 0) {
    makeRoom(net, LITTLE_ROOM);
    const h = CHAIN[depth - 1]!;
    const n = waitsFor(net, h);
    if (net.states[h] !== STATES[depth - 1]) depth--;
    else if (n !== NONE) {
      CHAIN[depth] = n;
      STATES[depth++] = net.states[n]!;
    } else {
      splitAs(net, h, examine(net, h, asked), asked);
      depth--;
    }
  }
}
