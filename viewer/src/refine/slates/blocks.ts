/**
 * Limit points and normals of patches, kept as deep as they were ever wanted.
 *
 * A patch has a block of (2^d + 1)^2 rows, of which coarser depths take every second, fourth, .. row and column; and for
 * each side beyond which it is deeper than its own block a rim of 2^d + 1 rows. Points do not move with the depth, so
 * a block is made anew only to become deeper.
 *
 * @module refine/slates/blocks
 */
import { Arena, longer, Ranges } from "./arena";
import { NONE } from "./layout";
import { Limits } from "./limits";
import type { SlateCage } from "./net";
import { tessellate } from "./patch";
import { rim } from "./rims";
import { type Column, type Work, workOf } from "./work";

/** Where things are in the rows. */
export interface Places {
  /** Of blocks; the depth is NONE where there is none. */
  readonly places: Int32Array;
  readonly depths: Int8Array;
  /** The same of sides. */
  readonly rims: Int32Array;
  readonly rimDepths: Int8Array;
}

/** What all placements want, at least: of each block, and along each side; NONE for none. */
export interface Wanted {
  readonly blocks: Int8Array;
  readonly rims: Int8Array;
}

export class Blocks {
  readonly places: Places;
  /** Positions, then further columns by three. */
  readonly limits: readonly Limits[];
  /** Limit points of each of `limits`, then normals: three a row. */
  columns: Column[];
  /** Patches of which something is elsewhere since the last `ensure`. */
  readonly isElsewhere: Uint8Array;
  #work: Work;
  #depth = 0;
  #written = new Ranges();
  readonly #arena = new Arena((rows) => {
    this.columns = this.columns.map((column) => longer(column, 3 * rows));
  });

  /**
   * @param columns - Positions of the mesh's vertices, then further columns, three doubles each.
   * @param isSingle - Whether what comes out is of 32 bits; all is computed in 64.
   */
  constructor(
    private readonly cage: SlateCage,
    columns: readonly Float64Array[],
    isSingle: boolean,
  ) {
    const { net, patches } = cage;
    const none = () => new Int8Array(patches).fill(NONE);
    this.places = {
      places: new Int32Array(patches),
      depths: none(),
      rims: new Int32Array(4 * patches),
      rimDepths: new Int8Array(4 * patches).fill(NONE),
    };
    this.isElsewhere = new Uint8Array(patches);
    this.limits = columns.map((column, i) => new Limits(net, cage.points(column), i === 0));
    this.columns = [...columns, null].map(() => (isSingle ? new Float32Array(0) : new Float64Array(0)));
    this.#work = workOf(net, 0);
  }

  get rows(): number {
    return this.#arena.rows;
  }

  /** Begins and ends of the rows that the last `ensure` wrote. */
  get changed(): number[] {
    return this.#written.bounds();
  }

  /** Blocks and rims as deep as wanted, at least; returns how many blocks were computed. */
  ensure(wanted: Wanted): number {
    this.#written = new Ranges();
    this.isElsewhere.fill(0);
    const patches = this.#placeBlocks(wanted);
    const sides = this.#placeRims(wanted);
    this.#arena.fit();
    this.#compute(patches, sides);
    return patches.length;
  }

  /** All are given back before the first is lent, so that the same rows come out on every machine. */
  #placeBlocks({ blocks }: Wanted): number[] {
    const { places, depths } = this.places;
    const fresh: number[] = [];
    for (let f = 0; f < blocks.length; f++) {
      if (blocks[f]! <= depths[f]!) continue;
      fresh.push(f);
      this.isElsewhere[f] = 1;
      if (depths[f] !== NONE) this.#arena.release([places[f]!, rowsOf(depths[f]!)]);
    }
    for (const f of fresh) {
      depths[f] = blocks[f]!;
      places[f] = this.#arena.allocate(rowsOf(depths[f]!));
      this.#written.add(places[f]!, rowsOf(depths[f]!));
    }
    return fresh;
  }

  #placeRims(wanted: Wanted): number[] {
    const { depths, rims, rimDepths } = this.places;
    const fresh: number[] = [];
    for (let h = 0; h < rims.length; h++) {
      const depth = wanted.rims[h]!;
      if (depth <= depths[h >> 2]! || depth <= rimDepths[h]!) continue;
      fresh.push(h);
      this.isElsewhere[h >> 2] = 1;
      if (rimDepths[h] !== NONE) this.#arena.release([rims[h]!, pointsOf(rimDepths[h]!)]);
    }
    for (const h of fresh) {
      rimDepths[h] = wanted.rims[h]!;
      rims[h] = this.#arena.allocate(pointsOf(rimDepths[h]!));
      this.#written.add(rims[h]!, pointsOf(rimDepths[h]!));
    }
    return fresh;
  }

  #compute(patches: readonly number[], sides: readonly number[]): void {
    const { net } = this.cage;
    const { places, depths, rims, rimDepths } = this.places;
    let deepest = this.#depth;
    for (const f of patches) deepest = Math.max(deepest, depths[f]!);
    for (const h of sides) deepest = Math.max(deepest, rimDepths[h]!);
    if (deepest > this.#depth) {
      this.#work = workOf(net, deepest);
      this.#depth = deepest;
    }
    const normals = this.columns.at(-1)!;
    this.limits.forEach((limits, i) => {
      const out = { positions: this.columns[i]!, normals };
      for (const f of patches) {
        tessellate(net, this.#work, limits, f, places[f]!, depths[f]!, out, i === 0);
      }
      for (const h of sides) rim(net, this.#work, limits, h, rims[h]!, rimDepths[h]!, out, i === 0);
    });
  }
}

function rowsOf(depth: number): number {
  return pointsOf(depth) ** 2;
}

function pointsOf(depth: number): number {
  return (1 << depth) + 1;
}
