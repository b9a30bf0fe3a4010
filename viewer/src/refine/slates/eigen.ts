/**
 * Limit points and tangents of settled rings, as left eigenvectors of their steps.
 *
 * Cosines and sines are those of `turn`, and square roots are exact: the same bits on every machine.
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

/**
 * Of the iteration for darts, whose second eigenvalue comes nearer to the first as 14 over the square of the valence: 36 /
 * 14 of that square give all digits. Beyond 110 faces the tangent is as near as it gets in a second.
 */
const MOST_WORK = 5_000_000;

/**
 * Left eigenvectors of the dart's own step, by pulling rows back again and again.
 *
 * Of those that the reflection which keeps e_0 turns over, the first is the tangent across. There v and e_0 are nothing, so
 * that the edge does not matter: it is the smooth vertex's.
 */
function dart(n: number): LimitRows {
  const ring: Ring = { faces: n, spokes: [Infinity, ...filled(n - 1, 0)], sharpness: 0 };
  const turns = Math.min(4 * n * n + 100, Math.floor(MOST_WORK / n));
  let { point, one, two } = inner(n);
  for (let i = 0; i < turns; i++) {
    const next = pulled(ring, point);
    const total = sum(next);
    point = next.map((w) => w / total);
  }
  for (let i = 0; i < turns; i++) one = nextTangent(pulled(ring, one), point);
  if (n === 2) two = Float64Array.of(0, 0, 0, 1, -1);
  return { point, one, two };
}

/**
 * The part of a row that the reflection keeps, without what belongs to the limit point: that has the sum of its weights,
 * since a ring that is one point stays there.
 */
function nextTangent(row: Float64Array, point: Float64Array): Float64Array {
  const n = point.length >> 1;
  const out = new Float64Array(row.length);
  out[0] = row[0]!;
  for (let i = 0; i < n; i++) {
    out[1 + i] = 0.5 * (row[1 + i]! + row[1 + ((n - i) % n)]!);
    out[1 + n + i] = 0.5 * (row[1 + n + i]! + row[1 + n + n - 1 - i]!);
  }
  const total = sum(out);
  let square = 0;
  for (let i = 0; i < out.length; i++) {
    out[i]! -= total * point[i]!;
    square += out[i]! * out[i]!;
  }
  const length = Math.sqrt(square);
  return out.map((w) => w / length);
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
