/**
 * Which triangles are shown: those of every patch of every placement, in runs that stay where they are.
 *
 * @module refine/slates/shown
 */
import { Arena, longer, Ranges } from "./arena";
import type { Blocks, Wanted } from "./blocks";
import { sideDepths, trianglesOf } from "./counts";
import { NONE } from "./layout";
import type { SlateCage } from "./net";
import { showEven, showFans } from "./triangles";

/** The triangles of `placements` times m patches. An entry is placement · m + patch. */
export class Shown {
  triangles = 0;
  /** Depths shown, NONE for holes; and of each entry's triangles in `faces` where they begin, and how many. */
  depths: Int8Array;
  readonly places: Int32Array;
  readonly counts: Int32Array;
  /** Three rows of points a triangle, (0, 0, 0) where there is none; and its depth. */
  faces = new Uint32Array(0);
  levels = new Uint8Array(0);
  #sides: Int8Array;
  #written = new Ranges();
  readonly #arena = new Arena((rows) => {
    this.faces = longer(this.faces, 3 * rows);
    this.levels = longer(this.levels, 4 * Math.ceil(rows / 4)); // whole words
  });

  constructor(
    private readonly cage: SlateCage,
    placements: number,
  ) {
    const count = placements * cage.patches;
    this.depths = new Int8Array(count).fill(NONE);
    this.#sides = new Int8Array(4 * count).fill(NONE);
    this.places = new Int32Array(count);
    this.counts = new Int32Array(count);
  }

  get rows(): number {
    return this.#arena.rows;
  }

  /** Begins and ends of the rows of `faces` that the last `show` wrote, also to clear them. */
  get changed(): number[] {
    return this.#written.bounds();
  }

  /** Of each entry's sides: the larger of the depths of the two patches. */
  along(depths: Int8Array): Int8Array {
    const sides = new Int8Array(4 * depths.length);
    sideDepths(this.cage.net, depths, sides);
    return sides;
  }

  /**
   * What all placements together need of blocks, and of the rims of fans.
   *
   * A patch beside a deeper one is computed a step deeper than it is shown: hubs and cut edges lie there.
   */
  wanted(depths: Int8Array, sides: Int8Array): Wanted {
    const m = this.cage.patches;
    const blocks = new Int8Array(m).fill(NONE);
    const rims = new Int8Array(4 * m).fill(NONE);
    for (let entry = 0; entry < depths.length; entry++) {
      const f = entry % m;
      let depth = depths[entry]!;
      for (let k = 0; k < 4; k++) {
        const side = sides[4 * entry + k]!;
        if (side <= depths[entry]!) continue;
        depth = depths[entry]! + 1;
        if (side > rims[4 * f + k]!) rims[4 * f + k] = side;
      }
      if (depth > blocks[f]!) blocks[f] = depth;
    }
    return { blocks, rims };
  }

  /** Write the triangles that are others now; returns of how many entries. */
  show(depths: Int8Array, sides: Int8Array, blocks: Blocks): number {
    this.#written = new Ranges();
    const chosen = this.#others(depths, sides, blocks.isElsewhere);
    this.depths = depths;
    this.#sides = sides;
    for (const entry of chosen) this.#clear(entry);
    for (const entry of chosen) {
      const h = 4 * entry;
      const [a, b, c, d] = [sides[h]!, sides[h + 1]!, sides[h + 2]!, sides[h + 3]!];
      this.counts[entry] = trianglesOf(depths[entry]!, a, b, c, d);
      this.triangles += this.counts[entry]!;
      this.places[entry] = this.#arena.allocate(this.counts[entry]!);
      this.#written.add(this.places[entry]!, this.counts[entry]!);
    }
    this.#arena.fit();
    for (const entry of chosen) this.#write(entry, blocks);
    return chosen.length;
  }

  /** Entries that are to be written anew. */
  #others(depths: Int8Array, sides: Int8Array, isElsewhere: Uint8Array): number[] {
    const chosen: number[] = [];
    for (let entry = 0; entry < depths.length; entry++) {
      let isOther = depths[entry] !== this.depths[entry];
      for (let h = 4 * entry; h < 4 * entry + 4; h++) isOther ||= sides[h] !== this.#sides[h];
      isOther ||= isElsewhere[entry % isElsewhere.length] === 1 && depths[entry]! >= 0;
      if (isOther) chosen.push(entry);
    }
    return chosen;
  }

  #clear(entry: number): void {
    const run = [this.places[entry]!, this.counts[entry]!] as const;
    const end = this.#arena.end(run);
    this.faces.fill(0, 3 * run[0], 3 * end);
    this.levels.fill(0, run[0], end);
    this.#arena.release(run);
    this.#written.add(...run);
    this.triangles -= run[1];
  }

  #write(entry: number, { places }: Blocks): void {
    const depth = this.depths[entry]!;
    if (depth < 0) return;
    const [place, f, h] = [this.places[entry]!, entry % this.cage.patches, 4 * entry];
    let isEven = true;
    for (let k = 0; k < 4; k++) isEven &&= this.#sides[h + k] === depth;
    if (isEven) showEven(places, f, depth, this.faces, place);
    else showFans(places, f, depth, this.#sides, h, this.faces, place);
    this.levels.fill(depth, place, place + this.counts[entry]!);
  }
}
