// Pass 1: the codes of the region growing to triangles. The twin of `connectivity` in _kernels_decode.py.
//
// Indices that come from the words are checked before they are used; the front's own links always name slots
// that are in use, because every step below keeps `following` and `previous` inverse to each other.

import {
  AT_DEAD,
  BOUNDARY,
  DEAD_CONTEXTS,
  END,
  FIRST,
  FOLLOWED_NEW,
  FOLLOWED_OTHER,
  FOLLOWED_RIGHT,
  FOLLOWED_RIGHTS,
  FRESH,
  FRESH_RIGHT,
  HEAD_DEGREES,
  LAST_CODES,
  LEFT,
  MET,
  NEW,
  RIGHT,
  SPLIT,
  SPLIT_NEXT,
  START,
  TAIL_DEGREES,
  WALK_AT,
  WALK_FAR,
  WALK_NEXT,
} from "./layout";
import * as memory_ from "./memory";
import { advance, at as placeAfter, LOW, number, raw, SLOT_MASK, x as stateAfter } from "./stream";

const FREE: u8 = 0;
const LIVE: u8 = 1;
const DEAD: u8 = 2;
const NONE: u32 = 0xffffffff;

/** Vertices that triangles use, state A and place in the words after `connectivity`. */
export let used: u32 = 0;
export let a: u32 = 0;
export let at: usize = 0;

// @ts-ignore: decorator
@inline
function slot(front: usize, s: u32): usize {
  return front + ((<usize>s) << 4);
}

// @ts-ignore: decorator
@inline
function following(front: usize, s: u32): u32 {
  return load<u32>(slot(front, s));
}

// @ts-ignore: decorator
@inline
function previous(front: usize, s: u32): u32 {
  return load<u32>(slot(front, s), 4);
}

// @ts-ignore: decorator
@inline
function origin(front: usize, s: u32): u32 {
  return load<u32>(slot(front, s), 8);
}

// @ts-ignore: decorator
@inline
function opposite(front: usize, s: u32): u32 {
  return load<u32>(slot(front, s), 12);
}

// @ts-ignore: decorator
@inline
function join(front: usize, s: u32, next: u32): void {
  store<u32>(slot(front, s), next);
  store<u32>(slot(front, next), s, 4);
}

// @ts-ignore: decorator
@inline
function count(degrees: usize, v: u32): void {
  const address = degrees + ((<usize>v) << 2);
  store<u32>(address, load<u32>(address) + 1);
}

/** The kind of the newest vertex once the code after it, or the one after that, is known. */
// @ts-ignore: decorator
@inline
function kindAfter(kind: u32, code: u32): u32 {
  if (kind < FRESH) return kind;
  if (kind == FRESH) {
    if (code == NEW) return FOLLOWED_NEW;
    if (code == RIGHT) return FRESH_RIGHT;
    return code == END ? FOLLOWED_RIGHT : FOLLOWED_OTHER;
  }
  return code == RIGHT || code == END ? FOLLOWED_RIGHTS : FOLLOWED_RIGHT;
}

/** Mark the gate dead, merge it with dead neighbours; the next live gate of its loop, or NONE. */
function closeEdge(front: usize, states: usize, start: u32): u32 {
  let gate = start;
  let next = following(front, gate);
  const before = previous(front, gate);
  store<u8>(states + gate, DEAD);
  if (before != gate && load<u8>(states + before) == DEAD) {
    store<u8>(states + gate, FREE);
    join(front, before, next);
    gate = before;
  }
  if (next != gate && load<u8>(states + next) == DEAD) {
    store<u8>(states + next, FREE);
    const beyond = following(front, next);
    join(front, gate, beyond);
    next = beyond;
  }
  return load<u8>(states + next) == LIVE ? next : NONE;
}

function step(front: usize, gate: u32, walk: u32): u32 {
  let s = gate;
  if (walk < WALK_NEXT) {
    for (let i: u32 = 0; i < walk + 4; i++) s = following(front, s);
  } else {
    for (let i: u32 = 0; i < walk - WALK_NEXT + 1; i++) s = previous(front, s);
  }
  return s;
}

/** Fill faces, corners, degrees and edges. Returns false if the words are no patch. */
export function connectivity(firstState: u32, firstPlace: usize): bool {
  const slots = memory_.slots;
  const choices = memory_.choices;
  const end = memory_.wordsEnd;
  const front = memory_.front;
  const states = memory_.states;
  const stack = memory_.stack;
  const degrees = memory_.degrees;
  const edges = memory_.edges;
  const corners = memory_.corners;
  const most = memory_.vertices;
  const faces = memory_.faces;
  const lastFace = faces + <usize>memory_.triangles * 12;
  let face = faces;
  let state = firstState;
  let place = firstPlace;
  let isDue = false;
  let vertices: u32 = 0;
  let slotsUsed: u32 = 0;
  let top: usize = stack;
  let kind: u32 = FIRST;
  let corner: usize = corners - 24; // of the newest vertex
  let gate: u32 = NONE;
  let last: u32 = START;
  while (face < lastFace || gate != NONE) {
    if (place > end) return false;
    if (gate == NONE) {
      if (vertices > 0) {
        kind = kindAfter(kind, START);
        store<u32>(corner, kind, 20);
      }
      const pattern = raw(3, state, place);
      state = stateAfter;
      place = placeAfter;
      for (let k: u32 = 0; k < 3; k++) {
        let v = vertices;
        if ((pattern >> k) & 1) {
          if (v >= most) return false;
          kind = FIRST;
          corner += 24;
          store<u32>(corner, kind, 20);
          vertices++;
        } else {
          const back = number(state, place);
          state = stateAfter;
          place = placeAfter;
          if (back >= vertices) return false;
          v = vertices - 1 - back;
        }
        store<u32>(face + ((<usize>k) << 2), v);
        count(degrees, v);
        const s = slotsUsed + k;
        const address = slot(front, s);
        store<u32>(address, k == 2 ? slotsUsed : s + 1);
        store<u32>(address, k == 0 ? slotsUsed + 2 : s - 1, 4);
        store<u32>(address, v, 8);
        store<u8>(states + s, LIVE);
      }
      store<u32>(slot(front, slotsUsed), load<u32>(face, 8), 12);
      store<u32>(slot(front, slotsUsed + 1), load<u32>(face), 12);
      store<u32>(slot(front, slotsUsed + 2), load<u32>(face, 4), 12);
      face += 12;
      gate = slotsUsed;
      slotsUsed += 3;
      last = START;
      continue;
    }
    const next = following(front, gate);
    const before = previous(front, gate);
    const tail = origin(front, gate);
    const head = origin(front, next);
    const nextState = load<u8>(states + next);
    const nextDead: u32 = nextState == DEAD ? 1 : 0;
    const beforeDead: u32 = load<u8>(states + before) == DEAD ? 1 : 0;
    const h = min<u32>(load<u32>(degrees + ((<usize>head) << 2)), HEAD_DEGREES) - 1;
    let context: u32;
    if (nextDead | beforeDead) {
      context = DEAD_CONTEXTS + h * 3 + nextDead + 2 * beforeDead - 1;
    } else {
      const t = min<u32>(load<u32>(degrees + ((<usize>tail) << 2)), TAIL_DEGREES) - 1;
      context = (h * TAIL_DEGREES + t) * LAST_CODES + last;
    }
    let entry = load<u32>(
      slots + (load<u32>(choices + ((<usize>context) << 2)) & ~15) + ((<usize>(state & SLOT_MASK)) << 2),
    );
    state = advance(entry, state);
    isDue = state < LOW;
    state = select<u32>((state << 16) | load<u16>(place), state, isDue);
    place += (<usize>isDue) << 1;
    last = entry & 0xff;
    if (last == BOUNDARY) {
      kind = kindAfter(kind, last);
      store<u32>(corner, kind, 20);
      store<u8>(edges + tail, 1);
      store<u8>(edges + head, 1);
      gate = closeEdge(front, states, gate);
    } else {
      if (face >= lastFace) return false;
      let v: u32;
      if (last == RIGHT) {
        if (next == gate || nextState != LIVE) return false;
        kind = kindAfter(kind, last);
        store<u32>(corner, kind, 20);
        const beyond = following(front, next);
        v = origin(front, beyond);
        store<u8>(states + next, FREE);
        join(front, gate, beyond);
        store<u32>(slot(front, gate), head, 12);
      } else if (last == NEW) {
        if (vertices >= most) return false;
        v = vertices++;
        store<u32>(corner, kindAfter(kind, last), 20);
        corner += 24;
        store<u32>(corner, tail);
        store<u32>(corner, head, 4);
        store<u32>(corner, opposite(front, gate), 8);
        if (nextState == LIVE && next != gate) {
          kind = FRESH;
          store<u32>(corner, origin(front, following(front, next)), 12);
          store<u32>(corner, opposite(front, next), 16);
        } else {
          kind = AT_DEAD;
          store<u32>(corner, tail, 12);
          store<u32>(corner, tail, 16);
        }
        store<u32>(corner, kind, 20);
        join(front, slotsUsed, next);
        join(front, gate, slotsUsed);
      } else if (last == LEFT) {
        if (before == gate || load<u8>(states + before) != LIVE) return false;
        kind = kindAfter(kind, last);
        store<u32>(corner, kind, 20);
        v = origin(front, before);
        store<u8>(states + gate, FREE);
        join(front, before, next);
        store<u32>(slot(front, before), tail, 12);
        gate = before;
      } else if (last == END) {
        if (nextState != LIVE || load<u8>(states + before) != LIVE) return false;
        if (following(front, next) != before || next == gate || before == gate || next == before) return false;
        kind = kindAfter(kind, last);
        store<u32>(corner, kind, 20);
        v = origin(front, before);
        store<u8>(states + gate, FREE);
        store<u8>(states + next, FREE);
        store<u8>(states + before, FREE);
        gate = NONE;
      } else {
        kind = kindAfter(kind, last);
        store<u32>(corner, kind, 20);
        if (last == MET) {
          const back = number(state, place);
          state = stateAfter;
          place = placeAfter;
          if (back >= vertices) return false;
          v = vertices - 1 - back;
          join(front, slotsUsed, next);
          join(front, gate, slotsUsed);
        } else {
          let met: u32;
          if (last == SPLIT_NEXT) {
            met = following(front, following(front, next));
          } else if (last == SPLIT) {
            entry = load<u32>(
              slots + (load<u32>(choices + (WALK_AT << 2)) & ~15) + ((<usize>(state & SLOT_MASK)) << 2),
            );
            state = advance(entry, state);
            if (state < LOW) {
              state = (state << 16) | load<u16>(place);
              place += 2;
            }
            const walk = entry & 0xff;
            if (walk == WALK_FAR) {
              const back = number(state, place);
              state = stateAfter;
              place = placeAfter;
              if (back >= slotsUsed) return false;
              met = slotsUsed - 1 - back;
            } else {
              met = step(front, gate, walk);
            }
          } else {
            met = previous(front, before);
          }
          if (load<u8>(states + met) == FREE || met == gate || met == next) return false;
          v = origin(front, met);
          store<u32>(top, gate);
          top += 4;
          join(front, slotsUsed, next);
          join(front, previous(front, met), slotsUsed);
          join(front, gate, met);
        }
      }
      if (last == NEW || last >= SPLIT) {
        const address = slot(front, slotsUsed);
        store<u8>(states + slotsUsed, LIVE);
        store<u32>(address, v, 8);
        store<u32>(address, tail, 12);
        store<u32>(slot(front, gate), head, 12);
        gate = slotsUsed++;
      }
      store<u32>(face, head);
      store<u32>(face, tail, 4);
      store<u32>(face, v, 8);
      face += 12;
      count(degrees, tail);
      count(degrees, head);
      count(degrees, v);
    }
    while (gate == NONE && top > stack) {
      top -= 4;
      const s = load<u32>(top);
      if (load<u8>(states + s) == LIVE) gate = s;
    }
  }
  used = vertices;
  a = state;
  at = place;
  return place <= end;
}
