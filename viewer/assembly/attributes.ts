// Pass 3: normals, as differences from those of the decoded geometry, and colours.

import { COLOUR_AT, FIRST, NORMAL_AT, SMALL_SCALES } from "./layout";
import { absolute, smallScale, value, valuePlace, valueState } from "./geometry";
import * as memory_ from "./memory";

export let a: u32 = 0;
export let b: u32 = 0;
export let at: usize = 0;

export function begin(firstA: u32, firstB: u32, firstPlace: usize): void {
  a = firstA;
  b = firstB;
  at = firstPlace;
}

function readA(context: u32): i64 {
  const read = value(context, a, at);
  a = valueState();
  at = valuePlace();
  return read;
}

function readB(context: u32): i64 {
  const read = value(context, b, at);
  b = valueState();
  at = valuePlace();
  return read;
}

/** sums[v] = the sum of the cross products of the triangles at v. */
function vertexNormals(): void {
  const positions = memory_.positions;
  const sums = memory_.sums;
  memory.fill(sums, 0, <usize>memory_.vertices * 24);
  const last = memory_.faces + <usize>memory_.triangles * 12;
  for (let face = memory_.faces; face < last; face += 12) {
    const a = positions + <usize>load<u32>(face) * 12;
    const b = positions + <usize>load<u32>(face, 4) * 12;
    const c = positions + <usize>load<u32>(face, 8) * 12;
    const ax = <i64>load<i32>(a);
    const ay = <i64>load<i32>(a, 4);
    const az = <i64>load<i32>(a, 8);
    const x = <i64>load<i32>(b) - ax;
    const y = <i64>load<i32>(b, 4) - ay;
    const z = <i64>load<i32>(b, 8) - az;
    const p = <i64>load<i32>(c) - ax;
    const q = <i64>load<i32>(c, 4) - ay;
    const r = <i64>load<i32>(c, 8) - az;
    const nx = y * r - z * q;
    const ny = z * p - x * r;
    const nz = x * q - y * p;
    for (let k: usize = 0; k < 12; k += 4) {
      const sum = sums + <usize>load<u32>(face + k) * 24;
      store<i64>(sum, load<i64>(sum) + nx);
      store<i64>(sum, load<i64>(sum, 8) + ny, 8);
      store<i64>(sum, load<i64>(sum, 16) + nz, 16);
    }
  }
}

// @ts-ignore: decorator
@inline
function floorDivide(x: i64, y: i64): i64 {
  const quotient = x / y;
  return quotient * y > x ? quotient - 1 : quotient;
}

const BIG: i64 = 1 << 40;
let pairU: i64 = 0;
let pairV: i64 = 0;

// @ts-ignore: decorator
@inline
function isBig(x: i64): bool {
  return x >= BIG || x <= -BIG;
}

/** The octahedral pair of a sum of cross products, to pairU and pairV. */
function octahedral(sumX: i64, sumY: i64, sumZ: i64, most: i64): void {
  let x = sumX;
  let y = sumY;
  let z = sumZ;
  while (isBig(x) || isBig(y) || isBig(z)) {
    x >>= 8;
    y >>= 8;
    z >>= 8;
  }
  const total = absolute(x) + absolute(y) + absolute(z);
  if (total == 0) {
    pairU = -most - 1;
    pairV = -most - 1;
    return;
  }
  pairU = floorDivide(2 * most * x + total, 2 * total);
  pairV = floorDivide(2 * most * y + total, 2 * total);
  if (z < 0) {
    const s = most - absolute(pairV);
    const t = most - absolute(pairU);
    pairU = x >= 0 ? s : -s;
    pairV = y >= 0 ? t : -t;
  }
}

/** Fill normals. Returns false if the words end too early. */
export function normals(bits: u32): bool {
  vertexNormals();
  const most: i64 = (<i64>1 << (bits - 1)) - 1;
  const end = memory_.wordsEnd;
  let out = memory_.normals;
  let sum = memory_.sums;
  let before: i64 = 0;
  for (let v: u32 = 0; v < memory_.vertices; v++, out += 4, sum += 24) {
    if (at > end) return false;
    octahedral(load<i64>(sum), load<i64>(sum, 8), load<i64>(sum, 16), most);
    const context = NORMAL_AT + (load<u8>(memory_.edges + v) ? 2 * SMALL_SCALES : 0);
    const u = readA(context + smallScale(before));
    const w = readB(context + SMALL_SCALES + smallScale(absolute(u)));
    before = absolute(u) + absolute(w);
    store<i16>(out, <i16>min<i64>(max<i64>(pairU + u, -most - 1), most));
    store<i16>(out, <i16>min<i64>(max<i64>(pairV + w, -most - 1), most), 2);
  }
  return at <= end;
}

/** Fill colours. Returns false if the words end too early. */
export function colours(used: u32): bool {
  const end = memory_.wordsEnd;
  const ycc = memory_.sums;
  let corner = memory_.corners;
  let out = memory_.colours;
  let here = ycc;
  for (let v: u32 = 0; v < memory_.vertices; v++, out += 3, here += 12, corner += 24) {
    if (at > end) return false;
    let y: i64 = 0;
    let o: i64 = 0;
    let g: i64 = 0;
    let contrast: i64 = 0;
    if (v < used && load<u32>(corner, 20) != FIRST) {
      const i = ycc + <usize>load<u32>(corner) * 12;
      const j = ycc + <usize>load<u32>(corner, 4) * 12;
      y = (<i64>load<i32>(i) + <i64>load<i32>(j)) >> 1;
      o = (<i64>load<i32>(i, 4) + <i64>load<i32>(j, 4)) >> 1;
      g = (<i64>load<i32>(i, 8) + <i64>load<i32>(j, 8)) >> 1;
      contrast = absolute(<i64>load<i32>(i) - <i64>load<i32>(j));
    } else if (v > 0) {
      y = <i64>load<i32>(here - 12);
      o = <i64>load<i32>(here - 8);
      g = <i64>load<i32>(here - 4);
    }
    const r = readA(COLOUR_AT + smallScale(contrast));
    const s = readB(COLOUR_AT + SMALL_SCALES + smallScale(absolute(r)));
    const q = readA(COLOUR_AT + 2 * SMALL_SCALES + smallScale(absolute(s) + (absolute(r) >> 1)));
    const luma = <i32>(y + r);
    const orange = <i32>(o + s);
    const green = <i32>(g + q);
    store<i32>(here, luma);
    store<i32>(here, orange, 4);
    store<i32>(here, green, 8);
    const middle = luma - (green >> 1);
    const blue = middle - (orange >> 1);
    store<u8>(out, <u8>(blue + orange));
    store<u8>(out, <u8>(middle + green), 1);
    store<u8>(out, <u8>blue, 2);
  }
  return at <= end;
}
