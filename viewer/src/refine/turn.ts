/**
 * Cosine and sine of a share of a full turn, the same to the last bit in every language.
 *
 * Libraries differ in the last bit of a cosine, and positions that are compared bit for bit lean on it. So the angle
 * is brought into the first eighth of a turn in whole numbers, where the first terms of the series are exact to
 * rounding. The same as `src/foveal/refine/_kernels_turn.py`.
 *
 * @module refine/turn
 */

const FULL = 6.283185307179586;

/** (cosine, sine) of i / n of a full turn; 0 <= i < n. */
export function turn(i: number, n: number): [cosine: number, sine: number] {
  const isBelow = 2 * i > n;
  let part = 2 * (isBelow ? n - i : i); // of 2 n: up to half a turn
  const isLeft = 2 * part > n;
  if (isLeft) part = n - part;
  const isSteep = 4 * part > n; // nearer to a quarter of a turn
  const x = isSteep ? (FULL * (n - 2 * part)) / (4 * n) : (FULL * part) / (2 * n);
  const across = cosineOf(x * x);
  const along = x * sineOf(x * x);
  const cosine = isSteep ? along : across;
  const sine = isSteep ? across : along;
  return [isLeft ? -cosine : cosine, isBelow ? -sine : sine];
}

/** Up to an eighth of a turn, whose square is q: the sine over the angle. */
function sineOf(q: number): number {
  let sum = 2.8114572543455206e-15;
  sum = sum * q - 7.647163731819816e-13;
  sum = sum * q + 1.6059043836821613e-10;
  sum = sum * q - 2.505210838544172e-8;
  sum = sum * q + 2.7557319223985893e-6;
  sum = sum * q - 0.0001984126984126984;
  sum = sum * q + 0.008333333333333333;
  sum = sum * q - 0.16666666666666666;
  return sum * q + 1;
}

function cosineOf(q: number): number {
  let sum = 4.779477332387385e-14;
  sum = sum * q - 1.1470745597729725e-11;
  sum = sum * q + 2.08767569878681e-9;
  sum = sum * q - 2.755731922398589e-7;
  sum = sum * q + 2.48015873015873e-5;
  sum = sum * q - 0.001388888888888889;
  sum = sum * q + 0.041666666666666664;
  sum = sum * q - 0.5;
  return sum * q + 1;
}
