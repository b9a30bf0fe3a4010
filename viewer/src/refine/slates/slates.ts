/**
 * Catmull-Clark surfaces tessellated on the fly: each patch as deep as a view needs it, without gaps.
 *
 * The control mesh is made of quadrangles by one step, where it has other faces; depths count from there. Limit points
 * and normals are kept between views and computed anew only where a patch gets deeper than it ever was; what the
 * triangles are depends on the view and the rules alone.
 *
 * Based on: V. Settgast, K. Müller, Chr. Fünfzig, D. Fellner. Adaptive tessellation of subdivision surfaces; T. DeRose, M.
 * Kass, T. Truong. Subdivision surfaces in character animation. SIGGRAPH 1998 (creases).
 *
 * @module refine/slates/slates
 */
import type { DepthRules } from "../../format/cage";
import type { PolygonMesh } from "../../format/polygons";
import { Blocks } from "./blocks";
import { NONE } from "./layout";
import { type SlateCage, slateCage } from "./net";
import { Placements } from "./placements";
import { Shown } from "./shown";
import { type View, Views } from "./views";

export interface SlatesOptions {
  /** What comes out is of 32 bits; all is computed in 64. */
  readonly isSingle?: boolean;
  readonly placements?: Placements;
  /** What sentences call the mesh. */
  readonly name?: string;
}

/** A Catmull-Clark surface that follows a camera, in one place or in many. */
export class Slates {
  readonly cage: SlateCage;
  /** Points and normals; and triangles of their rows. What does not change stays where it is. */
  readonly blocks: Blocks;
  readonly shown: Shown;
  readonly #views: Views;
  #placements: Placements;

  /** @throws Problem in a sentence, if the mesh is no oriented surface. */
  constructor(mesh: PolygonMesh, { isSingle = false, placements, name = "mesh" }: SlatesOptions = {}) {
    this.cage = slateCage(mesh, name);
    this.#placements = placements ?? new Placements();
    this.blocks = new Blocks(this.cage, columnsOf(mesh), isSingle);
    this.#views = new Views(this.cage, this.blocks.limits[0]!);
    this.shown = new Shown(this.cage, this.#placements.count);
  }

  /** Tessellate for a view, by rules; with triangles at most where `budget` is not null. */
  update(view: View, rules: DepthRules, budget: number | null = null): void {
    this.#show(this.#views.depths(view, rules, this.#placements, budget));
  }

  /** Tessellate at given depths, from 0 to 8: of each patch, or of each of each placement. */
  show(depths: ArrayLike<number>): void {
    const { patches, isShown } = this.cage;
    const chosen = new Int8Array(this.#placements.count * patches);
    for (let entry = 0; entry < chosen.length; entry++) {
      const isHole = isShown[entry % patches] === 0;
      chosen[entry] = isHole ? NONE : depths[entry % depths.length]!;
    }
    this.#show(chosen);
  }

  #show(depths: Int8Array): void {
    const sides = this.shown.along(depths);
    this.blocks.ensure(this.shown.wanted(depths, sides));
    this.shown.show(depths, sides, this.blocks);
  }
}

/** Positions, then the attributes by three columns. */
function columnsOf({ positions, colours, uvs }: PolygonMesh): Float64Array[] {
  const columns = [positions];
  if (colours) columns.push(Float64Array.from(colours));
  if (uvs) {
    const column = new Float64Array(positions.length);
    for (let v = 0; 2 * v < uvs.length; v++) column.set([uvs[2 * v]!, uvs[2 * v + 1]!], 3 * v);
    columns.push(column);
  }
  return columns;
}
