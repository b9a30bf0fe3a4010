/**
 * Bytes of a patch to arrays for the GPU: spec/patch.md.
 *
 * The work is done in WebAssembly (assembly/*.ts, embedded by assembly/build.mjs), twice as fast as Draco; this
 * file checks lengths, hands the bytes over and copies the results out. Pure: no network, no three.js; it runs
 * in a worker, in a test and in Node alike. Any bytes are safe: they give a patch whose indices are in range,
 * or an error with a sentence.
 *
 * @module format/patch
 */

import { PATCH_WASM } from "./patch.wasm";
import { Problem } from "./problem";
import { readTables } from "./tables";

/** A stream of the header's `streams`. */
export interface PatchStream {
  readonly name: string;
  readonly type: string;
  readonly bits?: number;
}

/** The most that one patch may hold; more is refused before anything is allocated. */
export interface PatchLimits {
  readonly vertices: number;
  readonly triangles: number;
}

/** A decoded patch. Every array has its exact size and a buffer of its own, so it can be transferred. */
export interface DecodedPatch {
  /** Three a vertex, on the grid of the whole file. */
  readonly positions: Int32Array<ArrayBuffer>;
  /** Three a triangle, each below the number of vertices. */
  readonly indices: Uint32Array<ArrayBuffer>;
  /** Octahedral pairs, two a vertex, in [-k, k] with k = 2^(bits - 1) - 1; (-k - 1, -k - 1) where there is none. */
  readonly normals: Int16Array<ArrayBuffer> | null;
  /** sRGB, three a vertex. */
  readonly colours: Uint8Array<ArrayBuffer> | null;
}

const LIMITS: PatchLimits = { vertices: 1 << 20, triangles: 1 << 21 };
const DAMAGED = "A patch is damaged: its bytes do not add up. Reload, or build the file again.";

/** The WebAssembly module's functions; addresses are bytes in its memory. */
interface Decoder {
  readonly memory: WebAssembly.Memory;
  reserveTables(tables: number): number;
  fillSlots(frequencies: number, tables: number): void;
  addressOfChoices(): number;
  addressOfWeights(): number;
  reservePatch(
    vertices: number,
    triangles: number,
    bytes: number,
    normals: boolean,
    colours: boolean,
  ): number;
  decode(coarse: number, normals: boolean, colours: boolean, normalBits: number): number;
  addressOfPositions(): number;
  addressOfFaces(): number;
  addressOfNormals(): number;
  addressOfColours(): number;
}

let compiled: Promise<WebAssembly.Module> | undefined;

function compile(): Promise<WebAssembly.Module> {
  const bytes = Uint8Array.from(atob(PATCH_WASM), (letter) => letter.charCodeAt(0));
  return WebAssembly.compile(bytes);
}

/** Decodes patches of one file, one after the other. Holds the file's tables; make one a file and worker. */
export class PatchDecoder {
  readonly normalBits: number;
  readonly #wasm: Decoder;
  readonly #hasNormals: boolean;
  readonly #hasColours: boolean;
  readonly #limits: PatchLimits;

  private constructor(
    wasm: Decoder,
    normalBits: number,
    streams: readonly PatchStream[],
    limits: PatchLimits,
  ) {
    this.#wasm = wasm;
    this.normalBits = normalBits;
    this.#hasNormals = streams.some((stream) => stream.name === "normal");
    this.#hasColours = streams.some((stream) => stream.name === "colour");
    this.#limits = limits;
  }

  /** @throws Problem with a sentence if the tables are damaged. */
  static async create(
    tables: Uint8Array,
    streams: readonly PatchStream[],
    limits: PatchLimits = LIMITS,
  ): Promise<PatchDecoder> {
    const { normalBits, frequencies, choices, weights } = readTables(tables);
    compiled ??= compile();
    const instance = await WebAssembly.instantiate(await compiled, {});
    const wasm = instance.exports as unknown as Decoder;
    const count = frequencies.length / 64;
    if (wasm.reserveTables(count) === 0) throw outOfMemory();
    // The frequencies lie for a moment where patches will.
    const place = wasm.reservePatch(0, 0, frequencies.byteLength, false, false);
    if (place === 0) throw outOfMemory();
    const { buffer } = wasm.memory;
    new Uint16Array(buffer, place, frequencies.length).set(frequencies);
    new Uint32Array(buffer, wasm.addressOfChoices(), choices.length).set(choices);
    new BigInt64Array(buffer, wasm.addressOfWeights(), weights.length).set(weights);
    wasm.fillSlots(place, count);
    return new PatchDecoder(wasm, normalBits, streams, limits);
  }

  /** @throws Problem with a sentence if the bytes are not a patch. */
  decode(bytes: Uint8Array): DecodedPatch {
    const [n, afterN] = varint(bytes, 0);
    const [m, afterM] = varint(bytes, afterN);
    const coarse = bytes[afterM] ?? 0;
    const start = afterM + 1;
    if (n > this.#limits.vertices || m > this.#limits.triangles) {
      const { vertices, triangles } = this.#limits;
      throw new Problem(
        "damaged",
        `A patch of ${n} vertices and ${m} triangles is larger than allowed (${vertices} and ${triangles}).`,
      );
    }
    const length = bytes.length - start;
    if (length < 8 || length % 2 !== 0) throw new Problem("damaged", DAMAGED);
    const wasm = this.#wasm;
    const place = wasm.reservePatch(n, m, length, this.#hasNormals, this.#hasColours);
    if (place === 0) throw outOfMemory();
    new Uint8Array(wasm.memory.buffer, place, length).set(bytes.subarray(start));
    if (!wasm.decode(coarse, this.#hasNormals, this.#hasColours, this.normalBits))
      throw new Problem("damaged", DAMAGED);
    const { buffer } = wasm.memory;
    return {
      positions: new Int32Array(buffer, wasm.addressOfPositions(), 3 * n).slice() as Int32Array<ArrayBuffer>,
      indices: new Uint32Array(buffer, wasm.addressOfFaces(), 3 * m).slice() as Uint32Array<ArrayBuffer>,
      normals: this.#hasNormals
        ? (new Int16Array(buffer, wasm.addressOfNormals(), 2 * n).slice() as Int16Array<ArrayBuffer>)
        : null,
      colours: this.#hasColours
        ? (new Uint8Array(buffer, wasm.addressOfColours(), 3 * n).slice() as Uint8Array<ArrayBuffer>)
        : null,
    };
  }
}

function outOfMemory(): Problem {
  return new Problem(
    "damaged",
    "There is not enough memory to decode a patch. Close other pages and reload.",
  );
}

/** A number of up to 35 bits, seven a byte, and where it ends. */
function varint(bytes: Uint8Array, start: number): [value: number, end: number] {
  let value = 0;
  for (let i = 0; i < 5; i++) {
    const byte = bytes[start + i];
    if (byte === undefined) throw new Problem("damaged", DAMAGED);
    value += (byte & 127) * 2 ** (7 * i);
    if (byte < 128) return [value, start + i + 1];
  }
  throw new Problem("damaged", DAMAGED);
}

/** Octahedral pairs as signed bytes x, y, z and an unused fourth, for a normalised GPU attribute. */
export function octahedralToInt8(normals: Int16Array, bits: number): Int8Array<ArrayBuffer> {
  const most = (1 << (bits - 1)) - 1;
  const out = new Int8Array(2 * normals.length);
  for (let i = 0, o = 0; i < normals.length; i += 2, o += 4) {
    const u = normals[i] as number;
    const v = normals[i + 1] as number;
    if (u < -most && v < -most) continue;
    let x = u;
    let y = v;
    const z = most - Math.abs(u) - Math.abs(v);
    if (z < 0) {
      x = (most - Math.abs(v)) * (u < 0 ? -1 : 1);
      y = (most - Math.abs(u)) * (v < 0 ? -1 : 1);
    }
    const scale = 127 / Math.hypot(x, y, z);
    out[o] = Math.round(x * scale);
    out[o + 1] = Math.round(y * scale);
    out[o + 2] = Math.round(z * scale);
  }
  return out;
}
