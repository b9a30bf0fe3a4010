/**
 * How a light projects, told from where the camera is: what the shader may compute in float32.
 *
 * A map of 2^20 pixels a side and depths of 32 bits do not fit float32. So all is told relative to a reference,
 * a point of the scene near the eye: its pixel and its depth as whole numbers, made in doubles here, and how
 * numerator and denominator of u, v and depth change with the difference to it. With c = pixel / n,
 *
 *     u n - pixel = n (X - c W) / W = (start + row . difference) / (w + row_w . difference),
 *
 * which is exact near the eye and elsewhere no worse than the difference itself: a few 2^-24 of the distance to the
 * eye, a ten-thousandth of a pixel of the picture. It holds behind the light, too, where W <= 0.
 */
import { Matrix4, type Vector3 } from "three";
import type { Projection, Row } from "../../format/light";
import type { Frame } from "../frame";

/** Texels of four numbers for each projection. */
export const SEEN_TEXELS = 8;
/** Depths are compared in the shader in 2^-30 of the light's range, since differences have to fit an int. */
export const SHADER_STEPS = 2 ** 30;
/** Whole parts of a depth go over as two numbers that float32 holds exactly. */
const PART = 2 ** 15;
const MOST_PIXEL = 2 ** 22;

export class SeenProjection {
  /**
   * @param pixels - Of the map, a side.
   * @param towards - As `towardsOf` finds it.
   */
  constructor(
    private readonly projection: Projection,
    private readonly pixels: number,
    private readonly towards: Row,
    private readonly frame: Frame,
  ) {}

  /**
   * Write the texels into `out` at `at`: rows of u, v and depth with their starts, row of W with W, the
   * reference's pixel and depth, the light, and the steps of one pixel where W is 1.
   *
   * @param eye - The camera's place in the scene's frame; its upper part is a rotation.
   * @param reference - In the scene's frame.
   */
  write(eye: Matrix4, reference: Vector3, out: Float32Array, at: number): void {
    const { pixels, frame } = this;
    const world = reference.toArray().map((x, a) => x / frame.scale + frame.centre[a]!) as Triple;
    const [x, y, z, w] = this.projection.map((row) => rowAt(row, world)) as unknown as Row;
    const rows = this.projection.map((row) => this.#seen(row, eye)) as unknown as readonly Triple[];
    const whole = [x, y].map((value) => wholePixel(value, w, pixels));
    for (const [axis, value] of [x, y].entries()) {
      const share = whole[axis]! / pixels;
      const row = rows[axis]!.map((a, i) => pixels * (a - share * rows[3]![i]!));
      out.set([...row, pixels * (value - share * w)], at + 4 * axis);
    }
    const depth = Math.max(0, Math.min(SHADER_STEPS, Math.floor(z * SHADER_STEPS))); // from there all fits an int
    out.set(
      rows[2]!.map((a) => a * SHADER_STEPS),
      at + 8,
    );
    out[at + 11] = z * SHADER_STEPS - depth;
    out.set([...rows[3]!, w], at + 12);
    const high = Math.floor(depth / PART);
    out.set([...whole, high, depth - high * PART], at + 16);
    writeLight(this.towards, frame, eye, out, at + 20);
    const [across, along] = stepsOf(this.projection);
    out.set(this.#steps(across, eye), at + 24);
    out.set(this.#steps(along, eye), at + 28);
  }

  /** A row's first three numbers for differences in the eye's own axes. */
  #seen(row: Row, eye: Matrix4): Triple {
    const e = eye.elements;
    const along = (i: number): number =>
      (row[0] * e[4 * i]! + row[1] * e[4 * i + 1]! + row[2] * e[4 * i + 2]!) / this.frame.scale;
    return [along(0), along(1), along(2)];
  }

  /** A step of the whole map in the world, as one of a pixel in the eye's own axes. */
  #steps(step: Triple, eye: Matrix4): Triple {
    const e = eye.elements;
    const along = (i: number): number =>
      ((step[0] * e[4 * i]! + step[1] * e[4 * i + 1]! + step[2] * e[4 * i + 2]!) * this.frame.scale) /
      this.pixels;
    return [along(0), along(1), along(2)];
  }
}

/**
 * Write where a light is (1 at the end), or the way to it (0), in the eye's own axes, into `out` at `at`.
 *
 * @param light - In the world's axes and unit.
 */
export function writeLight(
  [x, y, z, w]: Row,
  frame: Frame,
  eye: Matrix4,
  out: Float32Array,
  at: number,
): void {
  const inFrame = [x, y, z].map((value, a) => (w ? (value - frame.centre[a]!) * frame.scale : value));
  const e = new Matrix4().copy(eye).invert().elements;
  for (let a = 0; a < 3; a++) {
    out[at + a] = inFrame[0]! * e[a]! + inFrame[1]! * e[4 + a]! + inFrame[2]! * e[8 + a]! + w * e[12 + a]!;
  }
  out[at + 3] = w;
}

type Triple = [number, number, number];

function rowAt(row: Row, [x, y, z]: Triple): number {
  return row[0] * x + row[1] * y + row[2] * z + row[3];
}

/** The reference's pixel, or 0 where it has none; one far off the map is only a worse reference. */
function wholePixel(value: number, w: number, pixels: number): number {
  if (!(w > 0)) return 0;
  return Math.max(-MOST_PIXEL, Math.min(MOST_PIXEL, Math.floor((value / w) * pixels)));
}

/** Where a projection's light is (w = 1), or the way to it (w = 0), in the world's axes and unit. */
export function towardsOf([x, y, z, w]: Projection): Row {
  const along = cross(x, y);
  if (isParallel(w)) {
    // rays keep u and v, and depth grows the way the light travels
    const size = Math.hypot(...along) * (dot(along, z) > 0 ? -1 : 1);
    return [along[0] / size, along[1] / size, along[2] / size, 0];
  }
  // X = Y = W = 0 (Cramer)
  const [yw, wx] = [cross(y, w), cross(w, x)];
  const size = -dot(along, w);
  const at = (a: number): number => (x[3] * yw[a]! + y[3] * wx[a]! + w[3] * along[a]!) / size;
  return [at(0), at(1), at(2), 1];
}

/** The first two columns of the inverse that spec/shadows.md calls a and b. */
function stepsOf([x, y, z, w]: Projection): [Triple, Triple] {
  const last = isParallel(w) ? z : w;
  const volume = dot(cross(x, y), last);
  const divided = (vector: Triple): Triple => vector.map((value) => value / volume) as Triple;
  return [divided(cross(y, last)), divided(cross(last, x))];
}

function isParallel(w: Row): boolean {
  return w[0] === 0 && w[1] === 0 && w[2] === 0;
}

type Three = readonly [number, number, number, ...number[]];

function cross(a: Three, b: Three): Triple {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function dot(a: Three, b: Three): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
