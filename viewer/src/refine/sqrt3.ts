/**
 * √3 refinement for a view: the mesh is a function of control mesh, view and limits alone.
 *
 * - A face is split if it meets the criteria, or if a finer face beside it needs it to be; a vertex stands where
 *   uniform √3 subdivision has it on the highest generation of its faces. Nothing reads the mesh of the moment, so
 *   the result is the same whatever was looked at before, and the very same as Python's `foveal.refine.Sqrt3`:
 *   spec/refinement.md, golden/sqrt3.json.
 * - All in double precision. Knows no three.js, no network, no page: it runs in a worker and in a test.
 *
 * Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
 * √3-subdivision (the criteria, the structure without edges or hierarchy); L. Kobbelt. √3-subdivision. SIGGRAPH 2000
 * (the surface, adaptive refinement by forced mates).
 *
 * @module refine/sqrt3
 */
import { netOf } from "./base";
import type { Net } from "./net";
import { type Shown, showFaces, showVertex } from "./show";
import { type ControlMesh, surfaceOf } from "./surface";
import { coarsen, refine } from "./update";

/** Of the mesh's size: how far the view may move before all is asked anew. */
const FAR = 1000;

/** What an update did. */
export interface Update {
  /** Of the mesh now. */
  readonly faces: number;
  readonly vertices: number;
  readonly undone: number;
  /** False if there was more to split than was allowed. */
  readonly isDone: boolean;
}

export class Sqrt3 {
  readonly #net: Net;
  /** Of the control mesh's box, in which all levels lie. */
  readonly #low: number[];
  readonly #high: number[];
  readonly #size: number;
  #drift: number;
  #view = new Float64Array(24);
  #limits = new Float64Array(9);

  /**
   * @param name - What errors call the mesh.
   * @throws Problem if the mesh is no oriented surface.
   */
  constructor(mesh: ControlMesh, name = "mesh") {
    this.#net = netOf(surfaceOf(mesh, name));
    [this.#low, this.#high] = boxOf(mesh.positions);
    this.#size = Math.hypot(...this.#high.map((x, k) => x - this.#low[k]!));
    this.#drift = this.#size;
  }

  /**
   * Bring the mesh to a view, from where it is.
   *
   * @param view - 24 numbers, as `viewOf` makes them.
   * @param limits - 9 numbers, as `limitsOf` makes them.
   * @param mostSplits - Stop after about so many, with a mesh that is whole but not yet as fine as wanted. Further
   *   updates go on, and end in the very mesh that one without this limit makes.
   */
  update(view: Float64Array, limits: Float64Array, mostSplits = Infinity): Update {
    const net = this.#net;
    let undone = 0;
    // Of the same view the rest is done: what was forced for faces not split yet is not to be undone.
    const isSame = areEqual(view, this.#view) && areEqual(limits, this.#limits);
    if (!isSame) {
      this.#move(view, limits);
      undone = coarsen(net, this.#asked);
    }
    refine(net, net.vertices + mostSplits, this.#asked);
    return { faces: net.faces, vertices: net.vertices, undone, isDone: net.queued === 0 };
  }

  /** The faces as they are, slot by slot. */
  faces(): Shown {
    return showFaces(this.#net);
  }

  /** Vertex slots that `faces` may name. */
  get vertexSlots(): number {
    return this.#net.vertexSlots;
  }

  /** Write where the vertex of a slot is, three doubles at `at`. */
  place(v: number, isLimit: boolean, { highest }: Shown, out: Float64Array, at: number): void {
    showVertex(this.#net, v, isLimit, highest, out, at);
  }

  /** Write where it was born. */
  start(v: number, out: Float64Array, at: number): void {
    for (let k = 0; k < 3; k++) out[at + k] = this.#net.points[9 * v + k]!;
  }

  get #asked() {
    return { view: this.#view, limits: this.#limits, drift: this.#drift };
  }

  /** Add to the drift what the view moved by; for other limits or pixels no answer holds. */
  #move(view: Float64Array, limits: Float64Array): void {
    const before = this.#view;
    const eye = Math.hypot(view[0]! - before[0]!, view[1]! - before[1]!, view[2]! - before[2]!);
    let moved = eye;
    for (let i = 4; i < 24; i += 4) moved = Math.max(moved, this.#movedPlane(view, i));
    this.#drift += 1.001 * moved;
    const isOther = !areEqual(limits, this.#limits) || view[3] !== before[3];
    // Kept in 32 bits, the drift has to begin anew before a slack is nothing beside it.
    if (isOther || !(this.#drift <= FAR * this.#size)) {
      this.#net.faceUntil.fill(0, 0, this.#net.faceSlots);
      this.#net.vertexUntil.fill(0, 0, this.#net.vertexSlots);
      this.#drift = this.#size;
    }
    this.#view = view.slice();
    this.#limits = limits.slice();
  }

  /** By how much a plane moved, as seen from the box's corner that sees most of it. */
  #movedPlane(view: Float64Array, i: number): number {
    let least = view[i + 3]! - this.#view[i + 3]!;
    let most = least;
    for (let k = 0; k < 3; k++) {
      const slope = view[i + k]! - this.#view[i + k]!;
      const a = slope * this.#low[k]!;
      const b = slope * this.#high[k]!;
      least += Math.min(a, b);
      most += Math.max(a, b);
    }
    return Math.max(-least, most);
  }
}

function boxOf(positions: Float64Array): [low: number[], high: number[]] {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    const x = positions[i]!;
    if (x < low[i % 3]!) low[i % 3] = x;
    if (x > high[i % 3]!) high[i % 3] = x;
  }
  return [low, high];
}

function areEqual(a: Float64Array, b: Float64Array): boolean {
  return a.length === b.length && a.every((x, i) => x === b[i]);
}
