// The range coder's decoding half. The hot loops keep the states in locals and read symbols themselves, with
// `advance` and `isDue`; what is rare goes through the globals here.

import { PROBABILITY_BITS } from "./layout";

export const LOW: u32 = 65536;
export const SLOT_MASK: u32 = (1 << PROBABILITY_BITS) - 1;

/** State and place after the last call of `raw` or `number`. */
export let x: u32 = 0;
export let at: usize = 0;

/** The state behind a symbol. */
// @ts-ignore: decorator
@inline
export function advance(entry: u32, state: u32): u32 {
  return ((entry >> 8) & 0xfff) * (state >> PROBABILITY_BITS) + (entry >> 20);
}

/** Read n raw bits, 0 to 16. */
export function raw(n: u32, state: u32, place: usize): u32 {
  const value = state & ((1 << n) - 1);
  x = state >> n;
  at = place;
  if (x < LOW) {
    x = (x << 16) | load<u16>(place);
    at = place + 2;
  }
  return value;
}

/** Read a number in [0, 2^32). */
export function number(state: u32, place: usize): u32 {
  let n = raw(6, state, place);
  n = min<u32>(n, 32);
  let value = raw(min<u32>(n, 16), x, at);
  if (n > 16) value |= raw(n - 16, x, at) << 16;
  return n < 32 ? ((<u32>1 << n) | value) - 1 : value - 1;
}
