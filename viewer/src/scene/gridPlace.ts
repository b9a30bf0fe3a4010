/**
 * Where vertices are, told so that every patch that has a grid point draws it at the same place, bit for bit.
 *
 * With a matrix for each patch the last bits of a shared border vertex differed, and close to the surface (1e-4
 * of the scene's radius) up to 260 pixels of background showed through a border. Here whole numbers stay
 * whole until it does not matter any more which patch they came from:
 *
 *     grid point - reference = local position + (patch's centre - reference)      as 32-bit integers, exact
 *     seen from the eye      = toEye * float(grid point - reference)              one matrix for all patches
 *
 * What is rounded (the integer to a float beyond 2^24, then the product) is a function of the grid point and of
 * the picture alone. The reference is the grid point of the asset's box that is nearest to the eye: no point
 * of the box is then further from it than from the eye, so rounding moves nothing by more than a few 2^-24 of
 * its distance, a ten-thousandth of a pixel, in UTM coordinates and on grids of 30 bits alike.
 */
import { type Camera, Matrix4, Vector3 } from "three";
import type { MultiresInfo, Triple } from "../format/graph";
import type { Frame } from "./frame";

type Three = [number, number, number];

export class GridPlace {
  /** From grid points relative to the reference to the eye's own axes. */
  readonly toEye = new Matrix4();
  readonly #reference: Three = [0, 0, 0];
  /** Grid point g is at shift + scale * g in the scene's frame. */
  readonly #scale: number;
  readonly #shift: Three;
  readonly #box: readonly [Triple, Triple];
  readonly #eye = new Vector3();

  constructor({ origin, step, box }: Pick<MultiresInfo, "origin" | "step" | "box">, frame: Frame) {
    this.#scale = step * frame.scale;
    this.#shift = origin.map((x, a) => (x - frame.centre[a]!) * frame.scale) as Three;
    this.#box = box;
  }

  /** Choose the reference for this camera and make its matrix; in doubles, as three keeps its own. */
  follow(camera: Camera): void {
    const eye = this.#eye.setFromMatrixPosition(camera.matrixWorld).toArray();
    for (let a = 0; a < 3; a++) {
      const onGrid = (eye[a]! - this.#shift[a]!) / this.#scale;
      this.#reference[a] = Math.round(Math.min(Math.max(onGrid, this.#box[0][a]!), this.#box[1][a]!));
    }
    this.toEye.multiplyMatrices(camera.matrixWorldInverse, this.matrixOf(this.#reference));
  }

  /** From grid points relative to `centre` to the scene's frame. */
  matrixOf(centre: Triple, out = new Matrix4()): Matrix4 {
    const [x, y, z] = centre.map((g, a) => this.#shift[a]! + this.#scale * g) as Three;
    return out.makeScale(this.#scale, this.#scale, this.#scale).setPosition(x, y, z);
  }

  /** Write a patch's centre relative to the reference into `out`. */
  offsetOf(centre: Triple, out: Int32Array): void {
    for (let a = 0; a < 3; a++) out[a] = centre[a]! - this.#reference[a]!;
  }
}
