/**
 * The codec's shared tables, from the end of chunk 0: spec/patch.md, "Tables".
 *
 * Checked here as a whole, so that the WebAssembly decoder can trust them.
 *
 * @module format/tables
 */

import { Problem } from "./problem";

const KINDS = 5;
const DEGREES = 5;
const ROWS = 1 + 3 * DEGREES;
const CODES = 9;
const CODE_CONTEXTS = 441;
const WALKS = 32;
const CONTEXTS = 940;
const SYMBOLS = 64;
const PROBABILITY_BITS = 11;
const LONGEST_SHIFT = 15;

/** What the WebAssembly decoder takes. */
export interface CodecTables {
  /** Bits of each octahedral coordinate of normals. */
  readonly normalBits: number;
  /** 64 a table, summing to 2048. */
  readonly frequencies: Uint16Array;
  /** For each context the byte at which its table's slots begin, and its shift in the low four bits. */
  readonly choices: Uint32Array;
  /** Four a kind of vertex and three degrees. */
  readonly weights: BigInt64Array;
}

/** @throws Error with a sentence if the tables are damaged. */
export function readTables(bytes: Uint8Array): CodecTables {
  let at = 0;
  const byte = (): number => {
    const value = bytes[at++];
    if (value === undefined) throw damaged("they end too early");
    return value;
  };
  const varint = (): number => {
    let value = 0;
    for (let shift = 0; shift < 28; shift += 7) {
      const next = byte();
      value |= (next & 127) << shift;
      if (next < 128) return value;
    }
    throw damaged("a number that is too long");
  };

  const normalBits = byte();
  const tables = byte();
  if (normalBits < 4 || normalBits > 14 || tables === 0) throw damaged("their head");
  const parts = new Int8Array(KINDS * ROWS * 4);
  for (let i = 0; i < parts.length; i++) parts[i] = byte();

  const tableOf = new Uint8Array(CONTEXTS);
  const choices = new Uint32Array(CONTEXTS);
  for (let i = 0; i < CONTEXTS; ) {
    const table = byte();
    const shift = byte();
    const run = varint();
    if (table >= tables || shift > LONGEST_SHIFT || run < 1 || run > CONTEXTS - i)
      throw damaged("their contexts");
    tableOf.fill(table, i, i + run);
    choices.fill(((table << (PROBABILITY_BITS + 2)) | shift) >>> 0, i, i + run);
    i += run;
  }

  const frequencies = new Uint16Array(tables * SYMBOLS);
  for (let table = 0; table < tables; table++) {
    const first = byte();
    const last = byte();
    let sum = 0;
    for (let symbol = first; symbol <= last; symbol++) {
      const frequency = varint();
      if (symbol >= SYMBOLS || frequency > 1 << PROBABILITY_BITS) throw damaged("their frequencies");
      frequencies[table * SYMBOLS + symbol] = frequency;
      sum += frequency;
    }
    if (sum !== 1 << PROBABILITY_BITS) throw damaged("their frequencies");
  }
  for (let i = 0; i <= CODE_CONTEXTS; i++) {
    const table = (tableOf[i] as number) * SYMBOLS;
    const beyond = frequencies.subarray(table + (i < CODE_CONTEXTS ? CODES : WALKS), table + SYMBOLS);
    if (beyond.some((frequency) => frequency !== 0)) throw damaged("codes that do not exist");
  }
  if (at !== bytes.length) throw damaged("codes that do not exist");
  return { normalBits, frequencies, choices, weights: addUp(parts) };
}

/** Base and corrections added up for each kind and three degrees. */
function addUp(parts: Int8Array): BigInt64Array {
  const part = (kind: number, row: number, k: number): number => parts[(kind * ROWS + row) * 4 + k] as number;
  const out = new BigInt64Array(KINDS * DEGREES ** 3 * 4);
  let at = 0;
  for (let kind = 0; kind < KINDS; kind++)
    for (let a = 0; a < DEGREES; a++)
      for (let b = 0; b < DEGREES; b++)
        for (let v = 0; v < DEGREES; v++)
          for (let k = 0; k < 4; k++) {
            const sum =
              part(kind, 0, k) +
              part(kind, 1 + a, k) +
              part(kind, 1 + DEGREES + b, k) +
              part(kind, 1 + 2 * DEGREES + v, k);
            out[at++] = BigInt(sum);
          }
  return out;
}

function damaged(what: string): Problem {
  return new Problem("damaged", `The codec's tables are damaged (${what}). Copy or build the file again.`);
}
