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
 * The same as `src/foveal/refine/_kernels_sqrt3_update.py` and `_kernels_sqrt3_ask.py`.
 *
 * @module refine/update
 */
import {
  FREE,
  generation,
  half,
  isHalf,
  MAX_LEVEL,
  MEETS,
  NEEDED,
  type Net,
  NONE,
  PARENT,
  PARENTS,
  POINT,
  WANTED,
} from "./net";
import { split } from "./operators";
import { position, virtualApex } from "./points";
import { cornerAt, dequeue, enqueue } from "./slots";
import { unsplit } from "./undo";
import { isWanted, SLACK } from "./wanted";

/** What a mesh is asked for. */
export interface Asked {
  /** 24 numbers, as in `wanted.ts`. */
  readonly view: Float64Array;
  /** 9 numbers. */
  readonly limits: Float64Array;
  readonly drift: number;
}

/** Slots that a single examination may use: forced splits go down through the generations. */
const ROOM = 512;

/** What rounding a drift to 32 bits may have added is taken away before. */
const ROUNDED = 1 - 2 ** -22;

/** The corners of the triangle that is asked about; those of a half's two faces to be. */
const ASKED = new Float64Array(9);
const APEX = new Float64Array(3);

/** Up to which drift the last answer holds. In an array, since a number of a module would be allocated each time. */
const UNTIL = new Float64Array(1);

/** Whether the face of generation `level` at these vertices meets the criteria; SLACK says how long. */
function meets(net: Net, u: number, v: number, w: number, level: number, asked: Asked): boolean {
  position(net, u, level, ASKED, 0);
  position(net, v, level, ASKED, 3);
  position(net, w, level, ASKED, 6);
  return isWanted(asked.view, asked.limits, level, ASKED, net.normals, u, v, w);
}

/** Whether a face of generation `level` at these vertices has a parent that is wanted, or needs none. */
function hasWantedParent(net: Net, u: number, v: number, w: number, level: number): boolean {
  const { births, flags } = net;
  return (
    level === 0 ||
    (births[u] === level && (flags[u]! & WANTED) !== 0) ||
    (births[v] === level && (flags[v]! & WANTED) !== 0) ||
    (births[w] === level && (flags[w]! & WANTED) !== 0)
  );
}

/** The same of the face in which vertex v was born, by its flags. */
function wasWantedByParent(net: Net, v: number): boolean {
  const { flags, triples } = net;
  if (net.births[v] === 1) return true;
  const own = flags[v]!;
  for (let k = 0; k < 3; k++) {
    if ((own & (PARENT << k)) !== 0 && (flags[triples[3 * v + k]!]! & WANTED) !== 0) return true;
  }
  return false;
}

/** Whether a face is wanted, and UNTIL which drift. Without a wanted parent: until `wake` is told of one. */
function examine(net: Net, f: number, asked: Asked): boolean {
  const { corners } = net;
  const level = generation(net.states[f]!);
  const u = corners[3 * f]!;
  const v = corners[3 * f + 1]!;
  const w = corners[3 * f + 2]!;
  if (!hasWantedParent(net, u, v, w, level)) {
    UNTIL[0] = Infinity;
    return false;
  }
  const answer = meets(net, u, v, w, level, asked);
  UNTIL[0] = (asked.drift + SLACK[0]!) * ROUNDED;
  return answer;
}

/**
 * Whether the third, at edge w, x, of the birth face of vertex b is wanted: whether that is to flip.
 *
 * That is what is seen as long as the face beyond is not split.
 */
function wantsThird(net: Net, w: number, x: number, b: number, asked: Asked): boolean {
  const level = net.births[b]! - 1;
  position(net, w, level, ASKED, 0);
  position(net, x, level, ASKED, 3);
  for (let k = 0; k < 3; k++) ASKED[6 + k] = net.points[POINT * b + k]!;
  // b may have no normal yet; w, the older, is asked in its place.
  return isWanted(asked.view, asked.limits, level, ASKED, net.normals, w, x, w);
}

/**
 * Whether the face beyond half h is to be split, and UNTIL which drift.
 *
 * It is if the half itself is wanted, or one of the two faces that it is to be part of: for once these are there,
 * from another view, their parent on this side is reason enough to keep and split them.
 */
function examineHalf(net: Net, h: number, asked: Asked): boolean {
  const { corners } = net;
  const level = generation(net.states[h]!) + 1;
  const w = corners[3 * h]!;
  const x = corners[3 * h + 1]!;
  const b = corners[3 * h + 2]!;
  UNTIL[0] = Infinity;
  if ((net.flags[b]! & WANTED) === 0) return false;
  if (wantsThird(net, w, x, b, asked)) return true;
  let slack = SLACK[0]!;
  virtualApex(net, h, APEX, 0);
  position(net, w, level, ASKED, 0);
  ASKED.set(APEX, 3);
  position(net, b, level, ASKED, 6);
  if (isWanted(asked.view, asked.limits, level, ASKED, net.normals, w, x, b)) return true;
  slack = Math.min(slack, SLACK[0]!);
  position(net, x, level, ASKED, 0);
  position(net, b, level, ASKED, 3);
  ASKED.set(APEX, 6);
  const answer = isWanted(asked.view, asked.limits, level, ASKED, net.normals, x, b, w);
  UNTIL[0] = (asked.drift + Math.min(slack, SLACK[0]!)) * ROUNDED;
  return answer;
}

/** Whether a third beside the birth face of c, that of a wanted vertex, has c kept. */
function isSeenBeyond(net: Net, c: number, asked: Asked): boolean {
  const { births, flags, corners, beside } = net;
  const first = net.around[c]!;
  for (let isBack = 0; isBack < 2; isBack++) {
    let f = first;
    while (f !== NONE) {
      const k = cornerAt(net, f, c);
      const b = corners[3 * f + ((k + 1) % 3)]!;
      const n = beside[3 * f + k]!;
      // An edge between two vertices of one birth is what the flip of a longer one gave.
      const isFlip = n !== NONE && births[b] === births[c];
      if (isFlip && (flags[b]! & WANTED) !== 0 && wantsThird(net, oldest(net, f), oldest(net, n), b, asked)) {
        return true;
      }
      f = beside[3 * f + (isBack ? k : (k + 2) % 3)]!;
      if (f === first) return false;
    }
  }
  return false;
}

/** The oldest corner of a face, or of that which half f is a third of. */
function oldest(net: Net, f: number): number {
  return isHalf(net.states[f]!) ? net.triples[3 * net.corners[3 * f + 2]!]! : net.corners[3 * f]!;
}

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
  const { flags, triples, pairs } = net;
  for (const v of order) {
    const next = reviewed(net, v, asked);
    if ((next & ~flags[v]! & WANTED) !== 0) wake(net, v);
    flags[v] = next;
  }
  for (let i = order.length - 1; i >= 0; i--) {
    const v = order[i]!;
    if ((flags[v]! & (WANTED | NEEDED)) === 0) {
      if (!isSeenBeyond(net, v, asked)) continue;
      flags[v]! |= NEEDED;
      if (pairs[v] !== NONE) flags[pairs[v]!]! |= NEEDED;
    }
    const own = flags[v]!;
    for (let k = 0; k < 3; k++) {
      if ((own & (PARENT << k)) === 0) continue;
      const u = triples[3 * v + k]!;
      flags[u]! |= NEEDED;
      if (pairs[u] !== NONE) flags[pairs[u]!]! |= NEEDED;
    }
  }
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
    while (f !== NONE) {
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

/** Split face f, which is wanted itself (isOwn, UNTIL which drift) or only needed. */
function splitAs(net: Net, f: number, isOwn: boolean): void {
  const { flags, vertexUntil, pairs } = net;
  const holds = isOwn ? UNTIL[0]! : 0;
  const b = split(net, f);
  flags[b]! |= isOwn ? MEETS | WANTED : NEEDED;
  vertexUntil[b] = holds;
  const c = pairs[b]!;
  if (c !== NONE) {
    flags[c] = flags[b]!;
    vertexUntil[c] = holds;
  }
}

/**
 * Split what is wanted, beginning with the faces in the queue, until there are `most` vertices.
 *
 * First in, first out: so most mates are split when a half's turn comes, and need not be imagined.
 */
export function refine(net: Net, most: number, asked: Asked): void {
  while (net.queued > 0 && net.vertices < most) {
    const isFull = net.faceSlots + ROOM > net.states.length || net.vertexSlots + ROOM > net.births.length;
    if (isFull) net.grow();
    const f = dequeue(net);
    const state = net.states[f]!;
    if (state === FREE || net.faceUntil[f]! > asked.drift) continue;
    if (isHalf(state)) {
      if (examineHalf(net, f, asked)) force(net, f, asked);
      else net.faceUntil[f] = UNTIL[0]!;
    } else if (examine(net, f, asked)) {
      splitAs(net, f, true);
    } else {
      net.faceUntil[f] = UNTIL[0]!;
    }
  }
}

const CHAIN = new Int32Array(2 * MAX_LEVEL + 2);

/** Split the mate of half f; where a half of the last generation is in its place, its mate first. */
function force(net: Net, f: number, asked: Asked): void {
  const level = generation(net.states[f]!);
  let depth = 1;
  CHAIN[0] = f;
  while (depth > 0) {
    const h = CHAIN[depth - 1]!;
    const n = net.beside[3 * h]!;
    if (net.states[h] !== half(level - depth + 1)) depth--;
    else if (isHalf(net.states[n]!)) CHAIN[depth++] = n;
    else {
      splitAs(net, n, examine(net, n, asked));
      depth--;
    }
  }
}
