/**
 * Limit points and normals of control vertices as weights on their rings: v, then e_i, then f_i.
 *
 * A ring is closed under a step of subdivision, so while a vertex is semi-sharp the weights of its limit are pulled
 * back through its steps, and nothing has to be refined further than it is drawn.
 *
 * A normal belongs to a sector, the faces between two sharp spokes, and is the sum of cross products of pairs of
 * rows: one pair of tangents, or for corners of several faces, which have no tangent plane, the faces' areas at
 * the level from which all of the mesh is settled.
 *
 * Based on: Halstead, Kass, DeRose 1993, appendix A (limits, tangents); DeRose, Kass, Truong 1998 (creases). The
 * tangent across a crease is the left eigenvector of the standard rule's own step.
 *
 * @module refine/slates/masks
 */
import { across, type LimitRows, smooth } from "./eigen";
import { MOST_DEPTH } from "./layout";
import { after, CORNER, CREASE, kindOf, pulled, type Ring, sharpSpokes, stepsOf } from "./ringRules";

/** Faces between two sharp spokes, and the pairs of a mask's rows whose cross products are its normal. */
export interface Sector {
  readonly faces: readonly number[];
  /** First row of the pairs, which follow each other, and how many there are. */
  readonly pairs: readonly [first: number, count: number];
  /** Those to take where `pairs` give no direction. */
  readonly areas: readonly [first: number, count: number];
}

export interface Mask {
  /** Row 0 is the limit point; each of 1 + spokes + faces weights. */
  readonly rows: readonly Float64Array[];
  readonly sectors: readonly Sector[];
}

/** @param settled - After so many steps areas are taken. */
export function maskOf(ring: Ring, settled: number): Mask {
  if (ring.faces === 0) return { rows: [Float64Array.of(1)], sectors: [] }; // it stays, and has no normal
  const steps = stepsOf(ring);
  const last = after(ring, steps);
  const back = (row: Float64Array, count: number) => {
    let out = row;
    for (let i = count - 1; i >= 0; i--) out = pulled(after(ring, i), out);
    return out;
  };
  const rows = [back(limitRow(last), steps)];
  const sectors = sectorsOf(last).map((faces) => {
    const areas = [rows.length, faces.length] as const;
    for (const face of faces) rows.push(...areaRows(ring, face).map((row) => back(row, settled)));
    let pairs = areas;
    if (kindOf(last) !== CORNER || faces.length === 1) {
      pairs = [rows.length, 1];
      rows.push(...tangents(last, faces).map((row) => back(row, steps)));
    }
    return { faces, pairs, areas };
  });
  return { rows, sectors };
}

/** The faces of each, counter-clockwise. */
function sectorsOf(ring: Ring): number[][] {
  const n = ring.spokes.length;
  const sharp = sharpSpokes(ring);
  const range = (a: number, b: number) => Array.from({ length: b - a }, (_, i) => (a + i) % n);
  if (sharp.length === 0) return [range(0, ring.faces)];
  const inner = sharp.slice(1).map((b, i) => range(sharp[i]!, b));
  return n > ring.faces ? inner : [...inner, range(sharp.at(-1)!, sharp[0]! + n)];
}

/** From v across the face, and from its one spoke to the other. */
function areaRows({ spokes, faces }: Ring, face: number): Float64Array[] {
  const n = spokes.length;
  const size = 1 + n + faces;
  const rows = [new Float64Array(size), new Float64Array(size)];
  rows[0]![1 + n + face]! += 1;
  rows[0]![0]! -= 1;
  rows[1]![1 + ((face + 1) % n)]! += 1;
  rows[1]![1 + face]! -= 1;
  return rows;
}

function limitRow(ring: Ring): Float64Array {
  const row = new Float64Array(1 + ring.spokes.length + ring.faces);
  const kind = kindOf(ring);
  if (kind === CORNER) row[0] = 1;
  else if (kind === CREASE) {
    row[0] = 4 / 6;
    for (const i of sharpSpokes(ring)) row[1 + i] = 1 / 6;
  } else return turned(smoothOf(ring).point, ring);
  return row;
}

function tangents(ring: Ring, faces: readonly number[]): Float64Array[] {
  const n = ring.spokes.length;
  const kind = kindOf(ring);
  if (kind !== CORNER && kind !== CREASE) {
    const { one, two } = smoothOf(ring);
    return [turned(one, ring), turned(two, ring)];
  }
  const spokes = [1 + (faces[0]! % n), ...faces.map((f) => 1 + ((f + 1) % n))];
  const one = new Float64Array(1 + n + ring.faces);
  const two = new Float64Array(1 + n + ring.faces);
  if (kind === CORNER) {
    one.set([-1]);
    two.set([-1]);
    one[spokes[0]!] = 1;
    two[spokes[1]!] = 1;
    return [one, two];
  }
  one[spokes[0]!] = 1;
  one[spokes.at(-1)!] = -1;
  const columns = [0, ...spokes, ...faces.map((f) => 1 + n + f)];
  across(faces.length).forEach((weight, i) => {
    two[columns[i]!]! += weight;
  });
  return [one, two];
}

function smoothOf(ring: Ring): LimitRows {
  return smooth(ring.spokes.length, sharpSpokes(ring).length > 0);
}

/** From e_0 being the sharp spoke to where it is. */
function turned(weights: Float64Array, ring: Ring): Float64Array {
  const n = ring.spokes.length;
  const first = sharpSpokes(ring)[0] ?? 0;
  const out = weights.slice();
  for (let i = 0; i < n; i++) {
    const to = (i + first) % n;
    out[1 + to] = weights[1 + i]!;
    out[1 + n + to] = weights[1 + n + i]!;
  }
  return out;
}

/** Words a depth in a table of side masks. */
export const SIDE_WORDS = 8;

/**
 * Weights of a point inside a side, for each depth, while the side is semi-sharp.
 *
 * Of the limit point those of itself, its neighbours along, those across, the diagonal ones; of the tangent along
 * those of e_0 - e_2 and of the diagonals, of the tangent across the same. The side runs from e_2 to e_0, and the
 * rest follows by symmetry.
 */
export function sideMasks(sharpness: number): Float64Array {
  const out = new Float64Array(SIDE_WORDS * (MOST_DEPTH + 1));
  for (let depth = 0; depth <= MOST_DEPTH; depth++) {
    const left = Math.max(sharpness - depth, 0);
    const { rows } = maskOf({ faces: 4, spokes: [left, 0, left, 0], sharpness: 0 }, 0);
    const [point, along, over] = [rows[0]!, rows.at(-2)!, rows.at(-1)!];
    const own = [0, 1, 2, 5].map((i) => point[i]!);
    out.set([...own, along[1]!, along[5]!, over[2]!, over[5]!], SIDE_WORDS * depth);
  }
  return out;
}
