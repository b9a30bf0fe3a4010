// The module's entry: decodes one patch after `reserveTables` and `reservePatch`. spec/patch.md has the bytes.

import * as attributes from "./attributes";
import { a as connectedA, at as connectedAt, connectivity, used } from "./connectivity";
import { CONTEXTS, MOST_COARSE, PROBABILITY_BITS } from "./layout";
import { a, at, b, geometry } from "./geometry";
import * as memory_ from "./memory";
import { LOW } from "./stream";

export {
  addressOfChoices,
  addressOfColours,
  addressOfFaces,
  addressOfNormals,
  addressOfPositions,
  addressOfWeights,
  reservePatch,
  reserveTables,
} from "./memory";

export function contexts(): u32 {
  return CONTEXTS;
}

/** Turn frequencies (u16, 64 a table, checked to sum to 2^PROBABILITY_BITS) at `from` into slots. */
export function fillSlots(from: usize, tables: u32): void {
  let slot = memory_.slots;
  for (let t: u32 = 0; t < tables; t++) {
    for (let symbol: u32 = 0; symbol < 64; symbol++) {
      const frequency: u32 = load<u16>(from + ((<usize>(t * 64 + symbol)) << 1));
      for (let i: u32 = 0; i < frequency; i++, slot += 4) {
        store<u32>(slot, symbol | (frequency << 8) | (i << 20));
      }
    }
  }
}

export function slotsOfTable(): u32 {
  return 1 << PROBABILITY_BITS;
}

/** Decode the words that were written to the address that `reservePatch` gave; false if they are no patch. */
export function decode(coarse: u32, hasNormals: bool, hasColours: bool, normalBits: u32): bool {
  const words = memory_.words;
  if (memory_.wordsEnd < words + 8 || coarse > MOST_COARSE) return false;
  const firstA = load<u32>(words);
  const firstB = load<u32>(words, 4);
  if (firstA < LOW || firstB < LOW) return false;
  if (!connectivity(firstA, words + 8)) return false;
  if (!geometry(used, coarse, connectedA, firstB, connectedAt)) return false;
  attributes.begin(a, b, at);
  if (hasNormals && !attributes.normals(normalBits)) return false;
  if (hasColours && !attributes.colours(used)) return false;
  return attributes.a == LOW && attributes.b == LOW && attributes.at == memory_.wordsEnd;
}
