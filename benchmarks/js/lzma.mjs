/**
 * LZMA decoder in JavaScript, for measuring: the `.lzma` ("alone") format, into an array of known size.
 *
 * Based on: Pavlov, the LZMA specification (7-zip.org, public domain).
 */

const HALF = 1024; // the chance of a bit, in 2048ths, before anything is known

class Range {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at + 1; // the first byte is always 0
    this.range = 0xffffffff;
    this.code = 0;
    for (let i = 0; i < 4; i++) this.code = ((this.code << 8) | this.bytes[this.at++]) >>> 0;
  }

  normalise() {
    if (this.range < 0x1000000) {
      this.range = (this.range << 8) >>> 0;
      this.code = ((this.code << 8) | this.bytes[this.at++]) >>> 0;
    }
  }

  bit(chances, index) {
    const chance = chances[index];
    const bound = (this.range >>> 11) * chance;
    let bit = 0;
    if (this.code < bound) {
      this.range = bound;
      chances[index] = chance + ((2048 - chance) >> 5);
    } else {
      this.range -= bound;
      this.code -= bound;
      chances[index] = chance - (chance >> 5);
      bit = 1;
    }
    this.normalise();
    return bit;
  }

  direct(count) {
    let value = 0;
    for (let i = 0; i < count; i++) {
      this.range >>>= 1;
      const bit = this.code >= this.range ? 1 : 0;
      if (bit) this.code -= this.range;
      this.normalise();
      value = value * 2 + bit;
    }
    return value;
  }

  tree(chances, start, bits) {
    let node = 1;
    for (let i = 0; i < bits; i++) node = (node << 1) | this.bit(chances, start + node);
    return node - (1 << bits);
  }

  reverseTree(chances, start, bits) {
    let node = 1;
    let value = 0;
    for (let i = 0; i < bits; i++) {
      const bit = this.bit(chances, start + node);
      node = (node << 1) | bit;
      value |= bit << i;
    }
    return value;
  }
}

const fresh = (count) => new Uint16Array(count).fill(HALF);

class Lengths {
  constructor() {
    this.choice = fresh(2);
    this.low = fresh(16 << 3);
    this.mid = fresh(16 << 3);
    this.high = fresh(256);
  }

  read(range, position) {
    if (!range.bit(this.choice, 0)) return 2 + range.tree(this.low, position << 3, 3);
    if (!range.bit(this.choice, 1)) return 10 + range.tree(this.mid, position << 3, 3);
    return 18 + range.tree(this.high, 0, 8);
  }
}

function readDistance(range, length, models) {
  const slot = range.tree(models.slots, Math.min(length - 2, 3) << 6, 6);
  if (slot < 4) return slot;
  const bits = (slot >> 1) - 1;
  const base = (2 | (slot & 1)) * 2 ** bits;
  if (slot < 14) return base + range.reverseTree(models.places, base - slot, bits);
  return base + range.direct(bits - 4) * 16 + range.reverseTree(models.align, 0, 4);
}

function readLiteral(range, literals, out, at, lc, lp, state, distance) {
  const before = at > 0 ? out[at - 1] : 0;
  const context = ((at & ((1 << lp) - 1)) << lc) + (before >> (8 - lc));
  const start = 0x300 * context;
  let symbol = 1;
  if (state >= 7) {
    let match = out[at - distance - 1];
    while (symbol < 256) {
      const matchBit = (match >> 7) & 1;
      match <<= 1;
      const bit = range.bit(literals, start + ((1 + matchBit) << 8) + symbol);
      symbol = (symbol << 1) | bit;
      if (bit !== matchBit) break;
    }
  }
  while (symbol < 256) symbol = (symbol << 1) | range.bit(literals, start + symbol);
  return symbol & 255;
}

/** Fill `out` from `bytes`, which begin with the 13-byte header. */
export function decodeLzma(bytes, out) {
  const lc = bytes[0] % 9;
  const lp = Math.floor(bytes[0] / 9) % 5;
  const pb = Math.floor(bytes[0] / 45);
  const range = new Range(bytes, 13);
  const literals = fresh(0x300 << (lc + lp));
  const isMatch = fresh(12 << 4);
  const isRep = fresh(12);
  const isRep0 = fresh(12);
  const isRep1 = fresh(12);
  const isRep2 = fresh(12);
  const isLong = fresh(12 << 4);
  const models = { slots: fresh(4 << 6), places: fresh(128), align: fresh(16) };
  const lengths = new Lengths();
  const repLengths = new Lengths();
  let [rep0, rep1, rep2, rep3] = [0, 0, 0, 0];
  let state = 0;
  for (let at = 0; at < out.length; ) {
    const position = at & ((1 << pb) - 1);
    if (!range.bit(isMatch, (state << 4) + position)) {
      out[at] = readLiteral(range, literals, out, at, lc, lp, state, rep0);
      at++;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let length;
    if (!range.bit(isRep, state)) {
      [rep1, rep2, rep3] = [rep0, rep1, rep2];
      length = lengths.read(range, position);
      rep0 = readDistance(range, length, models);
      state = state < 7 ? 7 : 10;
    } else {
      if (!range.bit(isRep0, state)) {
        if (!range.bit(isLong, (state << 4) + position)) {
          state = state < 7 ? 9 : 11;
          out[at] = out[at - rep0 - 1];
          at++;
          continue;
        }
      } else if (!range.bit(isRep1, state)) {
        [rep0, rep1] = [rep1, rep0];
      } else if (!range.bit(isRep2, state)) {
        [rep0, rep1, rep2] = [rep2, rep0, rep1];
      } else {
        [rep0, rep1, rep2, rep3] = [rep3, rep0, rep1, rep2];
      }
      length = repLengths.read(range, position);
      state = state < 7 ? 8 : 11;
    }
    if (rep0 >= at) throw new RangeError("a match reaches before the beginning");
    for (const end = Math.min(at + length, out.length); at < end; at++) out[at] = out[at - rep0 - 1];
  }
}
