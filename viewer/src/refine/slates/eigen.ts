/**
 * Limit points and tangents of settled rings, as left eigenvectors of their steps.
 *
 * Cosines and sines are those of `turn`, the same on every machine; square roots are exact. Python has its
 * library's, so masks agree to 1e-15 or so and not to the last bit.
 *
 * @module refine/slates/eigen
 */
import { turn } from "../turn";
import { pulled, type Ring } from "./ringRules";

/** The limit point and two tangents, each of v, e_i, f_i. */
export interface LimitRows {
  readonly point: Float64Array;
  readonly one: Float64Array;
  readonly two: Float64Array;
}

const known = new Map<string, LimitRows>();

/** Of an inner vertex; of a dart its edge to e_0 is sharp for ever. */
export function smooth(n: number, isDart: boolean): LimitRows {
  const key = `${n} ${isDart}`;
  const rows = known.get(key) ?? (isDart ? dart(n) : inner(n));
  known.set(key, rows);
  return rows;
}

function inner(n: number): LimitRows {
  const share = n * (n + 5);
  const point = Float64Array.of(n ** 2 / share, ...filled(n, 4 / share), ...filled(n, 1 / share));
  if (n === 2) {
    // where the formula gives nothing: eigenvectors of its step, both for 1/4
    return { point, one: Float64Array.of(0, 1, -1, 0, 0), two: Float64Array.of(0, 0, 0, 1, -1) };
  }
  const cosine = turn(1, n)[0];
  const a = 1 + cosine + turn(1, 2 * n)[0] * Math.sqrt(2 * (9 + cosine));
  const [one, two] = [0, 1].map((which) => {
    const wave = Array.from({ length: n + 1 }, (_, i) => turn(i % n, n)[which]!);
    return Float64Array.of(
      0,
      ...wave.slice(0, n).map((w) => a * w),
      ...wave.slice(0, n).map((w, i) => w + wave[i + 1]!),
    );
  });
  return { point, one: one!, two: two! };
}

/** Steps of the iteration at most: 40 faces take 3,000, and more than 300 come near enough. */
const MOST_TURNS = 50_000;

/**
 * Of the vectors that the reflection which keeps e_0 keeps, the first belongs to 1 and the second is the tangent
 * along the edge. Of those it turns over the first is the tangent across; there v and e_0 are nothing, so that the
 * edge does not matter, and it is the smooth vertex's.
 */
function dart(n: number): LimitRows {
  const ring: Ring = { faces: n, spokes: [Infinity, ...filled(n - 1, 0)], sharpness: 0 };
  const plain = inner(n);
  const point = powered(ring, plain.point, (row) => scaled(row, 1 / sum(row)));
  const kept = (row: Float64Array) => {
    // What belongs to 1 has the sum of its weights, since a ring that is one point stays there.
    const total = sum(row);
    const rest = row.map((w, i) => w - total * point[i]!);
    return scaled(rest, 1 / Math.sqrt(rest.reduce((all, w) => all + w * w, 0)));
  };
  // For n = 2 the smooth vertex's is already what the edge makes of it; no other is orthogonal to what is sought.
  const one = powered(ring, kept(plain.one), kept);
  const two = n === 2 ? Float64Array.of(0, 0, 0, 1, -1) : plain.two;
  return { point, one, two };
}

/** Pull a row back until it stays the same. */
function powered(ring: Ring, first: Float64Array, norm: (row: Float64Array) => Float64Array): Float64Array {
  let row = first;
  for (let i = 0; i < MOST_TURNS; i++) {
    const next = norm(pulled(ring, row));
    const change = next.reduce((most, w, j) => Math.max(most, Math.abs(w - row[j]!)), 0);
    row = next;
    if (change < 1e-17) break;
  }
  return row;
}

/** Of the tangent across a crease into a sector of k faces: v, e_0 .. e_k, f_0 .. f_(k-1). */
export function across(k: number): Float64Array {
  if (k === 1) return Float64Array.of(-2, 1, 1, 0);
  const [cosine, sine] = turn(1, 2 * k);
  const [half, halfSine] = turn(1, 4 * k);
  const size = (5 + cosine + half * Math.sqrt(2 * (9 + cosine))) / 16;
  const a = 16 * size - 4;
  const cot = half / halfSine;
  const centre = -(8 * size * sine + (8 * size - 4) * (8 * size - 1) * cot) / (4 * size - 1);
  const end = -(centre + (16 * size - 2) * cot) / 2;
  const wave = Array.from({ length: k + 1 }, (_, i) => turn(i, 2 * k)[1]);
  const spokes = wave.slice(1, k).map((w) => a * w);
  const faces = wave.slice(0, k).map((w, i) => w + wave[i + 1]!);
  return Float64Array.of(centre, end, ...spokes, end, ...faces);
}

function filled(count: number, value: number): number[] {
  return new Array<number>(count).fill(value);
}

function sum(row: Float64Array): number {
  return row.reduce((all, w) => all + w, 0);
}

function scaled(row: Float64Array, share: number): Float64Array {
  return row.map((w) => w * share);
}
