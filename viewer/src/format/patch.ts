/**
 * Bytes of a patch to arrays for the GPU.
 *
 * @module format/patch
 */

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

/** Decodes patches of one file. Holds the file's shared tables; make one a file and worker. */
export class PatchDecoder {
  readonly normalBits: number;
  readonly #hasNormals: boolean;
  readonly #hasColours: boolean;
  readonly #limits: PatchLimits;

  private constructor(tables: Uint8Array, streams: readonly PatchStream[], limits: PatchLimits) {
    const bits = tables[0];
    if (tables.length !== 1 || bits === undefined || bits < 4 || bits > 14) {
      throw new Error("The codec's tables are damaged. Copy or build the file again.");
    }
    this.normalBits = bits;
    this.#hasNormals = streams.some((stream) => stream.name === "normal");
    this.#hasColours = streams.some((stream) => stream.name === "colour");
    this.#limits = limits;
  }

  /** @throws Error with a sentence if the tables are damaged. */
  static async create(
    tables: Uint8Array,
    streams: readonly PatchStream[],
    limits: PatchLimits = LIMITS,
  ): Promise<PatchDecoder> {
    return new PatchDecoder(tables, streams, limits);
  }

  /** @throws Error with a sentence if the bytes are not a patch. */
  decode(bytes: Uint8Array): DecodedPatch {
    if (bytes.length < 8) throw new Error("A patch ends too early. Reload, or build the file again.");
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const n = view.getUint32(0, true);
    const m = view.getUint32(4, true);
    const each = 12 + (this.#hasNormals ? 4 : 0) + (this.#hasColours ? 3 : 0);
    if (n > this.#limits.vertices || m > this.#limits.triangles || bytes.length !== 8 + each * n + 12 * m) {
      throw new Error("A patch's length does not fit its counts. Reload, or build the file again.");
    }
    let at = 8;
    const positions = new Int32Array(3 * n);
    for (let i = 0; i < 3 * n; i++, at += 4) positions[i] = view.getInt32(at, true);
    const indices = new Uint32Array(3 * m);
    for (let i = 0; i < 3 * m; i++, at += 4) {
      const index = view.getUint32(at, true);
      if (index >= n) throw new Error("A patch's triangle names a vertex that is not there.");
      indices[i] = index;
    }
    const normals = this.#hasNormals ? new Int16Array(2 * n) : null;
    if (normals) for (let i = 0; i < 2 * n; i++, at += 2) normals[i] = view.getInt16(at, true);
    const colours = this.#hasColours ? bytes.slice(at, at + 3 * n) : null;
    return { positions, indices, normals, colours };
  }
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
