// Numbers that encoder, decoder and specification share; the same as in src/foveal/multires/codec/layout.py.

export const NEW: u32 = 0;
export const RIGHT: u32 = 1;
export const LEFT: u32 = 2;
export const END: u32 = 3;
export const BOUNDARY: u32 = 4;
export const SPLIT: u32 = 5;
export const MET: u32 = 6;
export const SPLIT_NEXT: u32 = 7;
export const START: u32 = 9;

export const HEAD_DEGREES: u32 = 7;
export const TAIL_DEGREES: u32 = 6;
export const LAST_CODES: u32 = 10;
export const DEAD_CONTEXTS: u32 = HEAD_DEGREES * TAIL_DEGREES * LAST_CODES;
export const CODE_CONTEXTS: u32 = DEAD_CONTEXTS + 3 * HEAD_DEGREES;

export const WALK_NEXT: u32 = 16;
export const WALK_FAR: u32 = 31;

export const FOLLOWED_NEW: u32 = 0;
export const FOLLOWED_RIGHT: u32 = 1;
export const FOLLOWED_RIGHTS: u32 = 2;
export const FOLLOWED_OTHER: u32 = 3;
export const AT_DEAD: u32 = 4;
export const FIRST: u32 = 5;
export const FRESH: u32 = 6;
export const FRESH_RIGHT: u32 = 7;

export const KINDS: u32 = 5;
export const DEGREES: u32 = 5;
export const LEAST_DEGREE: u32 = 4;
export const WEIGHT_BITS: i64 = 6;

export const SCALES: u32 = 64;
export const SMALL_SCALES: u32 = 16;

export const ESCAPE: u32 = 63;
export const MIDDLE: i64 = 31;

export const WALK_AT: u32 = CODE_CONTEXTS;
export const ALONG_AT: u32 = WALK_AT + 1;
export const ACROSS_AT: u32 = ALONG_AT + SCALES * DEGREES;
export const COLOUR_AT: u32 = ACROSS_AT + SCALES;
export const NORMAL_AT: u32 = COLOUR_AT + 3 * SMALL_SCALES;
export const COARSE_AT: u32 = NORMAL_AT + 4 * SMALL_SCALES;
export const CONTEXTS: u32 = COARSE_AT + 2;

export const MOST_COARSE: u32 = 15;

export const PROBABILITY_BITS: u32 = 11;
