/**
 * Whether faces of a √3 refinement are wanted split, and up to which drift of the view that holds.
 *
 * The same as `src/foveal/refine/_kernels_sqrt3_ask.py`.
 *
 * @module refine/ask
 */
import { generation, isHalf, type Net, PARENT, POINT, WANTED } from "./net";
import { position, virtualApex } from "./points";
import { cornerAt } from "./slots";
import { isWanted, SLACK } from "./wanted";

/** What a mesh is asked for. */
export interface Asked {
  /** 24 numbers, as in `wanted.ts`. */
  readonly view: Float64Array;
  /** 9 numbers. */
  readonly limits: Float64Array;
  readonly drift: number;
}

/** What rounding a drift to 32 bits may have added is taken away before. */
export const ROUNDED = 1 - 2 ** -22;

/** The corners of the triangle that is asked about; those of a half's two faces to be. */
const ASKED = new Float64Array(9);
const APEX = new Float64Array(3);

/** Up to which drift the last answer holds. In an array, since a number of a module would be allocated each time. */
export const UNTIL = new Float64Array(1);

/** Whether the face of generation `level` at these vertices meets the criteria; SLACK says how long. */
export function meets(net: Net, u: number, v: number, w: number, level: number, asked: Asked): boolean {
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
export function wasWantedByParent(net: Net, v: number): boolean {
  const { flags, triples } = net;
  if (net.births[v] === 1) return true;
  const own = flags[v]!;
  for (let k = 0; k < 3; k++) {
    if ((own & (PARENT << k)) !== 0 && (flags[triples[3 * v + k]!]! & WANTED) !== 0) return true;
  }
  return false;
}

/** Whether a face is wanted, and UNTIL which drift. Without a wanted parent: until `wake` is told of one. */
export function examine(net: Net, f: number, asked: Asked): boolean {
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
export function examineHalf(net: Net, h: number, asked: Asked): boolean {
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
export function isSeenBeyond(net: Net, c: number, asked: Asked): boolean {
  const { births, flags, corners, beside } = net;
  const first = net.around[c]!;
  for (let isBack = 0; isBack < 2; isBack++) {
    let f = first;
    while (f >= 0) {
      const k = cornerAt(net, f, c);
      const b = corners[3 * f + ((k + 1) % 3)]!;
      const n = beside[3 * f + k]!;
      // An edge between two vertices of one birth is what the flip of a longer one gave.
      const isFlip = n >= 0 && births[b] === births[c];
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
