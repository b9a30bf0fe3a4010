// Pass 2: positions. The twin of `geometry` in _kernels_decode.py; integers of 64 bits that wrap around, and
// one division of doubles whose rounding IEEE 754 fixes.

import {
  ACROSS_AT,
  ALONG_AT,
  COARSE_AT,
  DEGREES,
  ESCAPE,
  FIRST,
  FOLLOWED_OTHER,
  FOLLOWED_RIGHT,
  FRESH,
  LEAST_DEGREE,
  MIDDLE,
  SCALES,
  SMALL_SCALES,
  WEIGHT_BITS,
} from "./layout";
import * as memory_ from "./memory";
import { advance, at as placeAfter, LOW, number, SLOT_MASK, x as stateAfter } from "./stream";

/** States and place after `geometry`, and after `finish`. */
export let a: u32 = 0;
export let b: u32 = 0;
export let at: usize = 0;
let state_: u32 = 0;
let place_: usize = 0;

// @ts-ignore: decorator
@inline
function degreeClass(degrees: usize, v: u32): u32 {
  const degree = load<u32>(degrees + ((<usize>v) << 2));
  return min<u32>(max<u32>(degree, LEAST_DEGREE) - LEAST_DEGREE, DEGREES - 1);
}

/** The class of a length >= 0: two an octave of length + 1. */
// @ts-ignore: decorator
@inline
export function scale(length: i64): u32 {
  const x = <u64>length + 1;
  const exponent = 63 - clz<u64>(x);
  const half = exponent > 0 ? (x >> (exponent - 1)) & 1 : 0;
  return min<u32>(<u32>(2 * exponent + half), SCALES - 1);
}

// @ts-ignore: decorator
@inline
export function smallScale(length: i64): u32 {
  return min<u32>(scale(length), SMALL_SCALES - 1);
}

// @ts-ignore: decorator
@inline
export function absolute(x: i64): i64 {
  return x < 0 ? -x : x;
}

export function unzigzag(x: u32): i64 {
  return <i64>(x >> 1) ^ -(<i64>(x & 1));
}

/** A value whose symbol is the escape, or that has raw bits below its symbol. */
function finish(symbol: u32, shift: u32, state: u32, place: usize): i64 {
  if (symbol == ESCAPE) {
    const value = unzigzag(number(state, place));
    state_ = stateAfter;
    place_ = placeAfter;
    return value;
  }
  const low = state & ((1 << shift) - 1);
  state_ = state >> shift;
  place_ = place;
  if (state_ < LOW) {
    state_ = (state_ << 16) | load<u16>(place);
    place_ = place + 2;
  }
  return ((<i64>symbol - MIDDLE) << (<i64>shift)) | (<i64>low);
}

/** One value in its context; state and place go to `valueState` and `valuePlace`. For the rarer streams. */
export function value(context: u32, state: u32, place: usize): i64 {
  const choice = load<u32>(memory_.choices + ((<usize>context) << 2));
  const entry = load<u32>(memory_.slots + (choice & ~15) + ((<usize>(state & SLOT_MASK)) << 2));
  state_ = advance(entry, state);
  place_ = place;
  if (state_ < LOW) {
    state_ = (state_ << 16) | load<u16>(place);
    place_ = place + 2;
  }
  const symbol = entry & 0xff;
  if (symbol == ESCAPE || (choice & 15) != 0) return finish(symbol, choice & 15, state_, place_);
  return <i64>symbol - MIDDLE;
}

export function valueState(): u32 {
  return state_;
}

export function valuePlace(): usize {
  return place_;
}

/** Fill positions, those of vertices that no triangle uses too. Returns false if the words end too early. */
export function geometry(used: u32, coarse: u32, firstA: u32, firstB: u32, firstPlace: usize): bool {
  const slots = memory_.slots;
  const choices = memory_.choices;
  const weights = memory_.weights;
  const positions = memory_.positions;
  const degrees = memory_.degrees;
  const vertices = memory_.vertices;
  const end = memory_.wordsEnd;
  let corner = memory_.corners;
  let position = positions;
  let stateA = firstA;
  let stateB = firstB;
  let place = firstPlace;
  let isDue = false;
  let wasCoarse: u32 = 0;
  for (let v: u32 = 0; v < vertices; v++, position += 12, corner += 24) {
    if (place > end) return false;
    let kind: u32 = v < used ? load<u32>(corner, 20) : FIRST;
    if (kind == FIRST) {
      for (let k: usize = 0; k < 12; k += 4) {
        const before: i64 = v > 0 ? <i64>load<i32>(position - 12 + k) : 0;
        const difference = unzigzag(number(stateA, place));
        stateA = stateAfter;
        place = placeAfter;
        store<i32>(position + k, <i32>(before + difference));
      }
      continue;
    }
    if (kind >= FRESH) kind = kind == FRESH ? FOLLOWED_OTHER : FOLLOWED_RIGHT;
    const ia = load<u32>(corner);
    const ib = load<u32>(corner, 4);
    const d = degreeClass(degrees, v);
    const row = ((kind * DEGREES + degreeClass(degrees, ia)) * DEGREES + degreeClass(degrees, ib)) * DEGREES + d;
    const w = weights + ((<usize>row) << 5);
    const wb = load<i64>(w);
    const wo = load<i64>(w, 8);
    const wn = load<i64>(w, 16);
    const wp = load<i64>(w, 24);
    const pa = positions + <usize>ia * 12;
    const pb = positions + <usize>ib * 12;
    const po = positions + <usize>load<u32>(corner, 8) * 12;
    const pn = positions + <usize>load<u32>(corner, 12) * 12;
    const pp = positions + <usize>load<u32>(corner, 16) * 12;
    const ax = <i64>load<i32>(pa);
    const ay = <i64>load<i32>(pa, 4);
    const az = <i64>load<i32>(pa, 8);
    const bx = <i64>load<i32>(pb) - ax;
    const by = <i64>load<i32>(pb, 4) - ay;
    const bz = <i64>load<i32>(pb, 8) - az;
    const ox = <i64>load<i32>(po) - ax;
    const oy = <i64>load<i32>(po, 4) - ay;
    const oz = <i64>load<i32>(po, 8) - az;
    let nx = <i64>load<i32>(pn) - ax;
    let ny = <i64>load<i32>(pn, 4) - ay;
    let nz = <i64>load<i32>(pn, 8) - az;
    let px = <i64>load<i32>(pp) - ax;
    let py = <i64>load<i32>(pp, 4) - ay;
    let pz = <i64>load<i32>(pp, 8) - az;
    const half: i64 = 1 << (WEIGHT_BITS - 1);
    let x = ax + ((wb * bx + wo * ox + wn * nx + wp * px + half) >> WEIGHT_BITS);
    let y = ay + ((wb * by + wo * oy + wn * ny + wp * py + half) >> WEIGHT_BITS);
    let z = az + ((wb * bz + wo * oz + wn * nz + wp * pz + half) >> WEIGHT_BITS);
    let size = absolute(bx) + absolute(by) + absolute(bz) + absolute(ox) + absolute(oy) + absolute(oz);

    let c: i64 = 0;
    if (coarse != 0) {
      const flag = value(COARSE_AT + wasCoarse, stateB, place);
      stateB = state_;
      place = place_;
      wasCoarse = flag != 0 ? 1 : 0;
      c = flag != 0 ? <i64>coarse : 0;
      const middle = (<i64>1 << c) >> 1;
      x = (x + middle) >> c;
      y = (y + middle) >> c;
      z = (z + middle) >> c;
      size >>= c;
    }

    // Both symbols of one table, then the third: none waits for another's value.
    const e = scale(size);
    const choice = load<u32>(choices + ((<usize>(ALONG_AT + d * SCALES + e)) << 2));
    const choiceQ = load<u32>(choices + ((<usize>(ACROSS_AT + e)) << 2));
    const table = slots + (choice & ~15);
    let entry = load<u32>(table + ((<usize>(stateA & SLOT_MASK)) << 2));
    stateA = advance(entry, stateA);
    isDue = stateA < LOW;
    stateA = select<u32>((stateA << 16) | load<u16>(place), stateA, isDue);
    place += (<usize>isDue) << 1;
    let symbol = entry & 0xff;
    let r = <i64>symbol - MIDDLE;
    if (symbol == ESCAPE || (choice & 15) != 0) {
      r = finish(symbol, choice & 15, stateA, place);
      stateA = state_;
      place = place_;
    }

    entry = load<u32>(table + ((<usize>(stateB & SLOT_MASK)) << 2));
    stateB = advance(entry, stateB);
    isDue = stateB < LOW;
    stateB = select<u32>((stateB << 16) | load<u16>(place), stateB, isDue);
    place += (<usize>isDue) << 1;
    symbol = entry & 0xff;
    let s = <i64>symbol - MIDDLE;
    if (symbol == ESCAPE || (choice & 15) != 0) {
      s = finish(symbol, choice & 15, stateB, place);
      stateB = state_;
      place = place_;
    }

    entry = load<u32>(slots + (choiceQ & ~15) + ((<usize>(stateA & SLOT_MASK)) << 2));
    stateA = advance(entry, stateA);
    isDue = stateA < LOW;
    stateA = select<u32>((stateA << 16) | load<u16>(place), stateA, isDue);
    place += (<usize>isDue) << 1;
    symbol = entry & 0xff;
    let q = <i64>symbol - MIDDLE;
    if (symbol == ESCAPE || (choiceQ & 15) != 0) {
      q = finish(symbol, choiceQ & 15, stateA, place);
      stateA = state_;
      place = place_;
    }

    nx -= bx;
    ny -= by;
    nz -= bz;
    px -= bx;
    py -= by;
    pz -= bz;
    const cx = <f64>(by * oz - bz * oy + ny * pz - nz * py);
    const cy = <f64>(bz * ox - bx * oz + nz * px - nx * pz);
    const cz = <f64>(bx * oy - by * ox + nx * py - ny * px);
    const isX = abs(cx) >= abs(cy) && abs(cx) >= abs(cz);
    const isY = !isX && abs(cy) >= abs(cz);
    const alongI = select(cy, select(cz, cx, isY), isX);
    const alongJ = select(cz, select(cx, cy, isY), isX);
    const alongK = select(cx, select(cy, cz, isY), isX);
    if (alongK != 0) q += <i64>floor(0.5 - (alongI * <f64>r + alongJ * <f64>s) / alongK);
    x += select(q, select(s, r, isY), isX);
    y += select(r, select(q, s, isY), isX);
    z += select(s, select(r, q, isY), isX);
    store<i32>(position, <i32>(x << c));
    store<i32>(position, <i32>(y << c), 4);
    store<i32>(position, <i32>(z << c), 8);
  }
  a = stateA;
  b = stateB;
  at = place;
  return place <= end;
}
