/** Matrices of placements: what they do to lengths, and which are none. */
import { expect, test } from "vitest";
import { placementsOf, stretchOf } from "./placements";

const PLAIN = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function read(...numbers: number[]): Float64Array | null {
  return placementsOf(new Uint8Array(Float64Array.from(numbers).buffer), numbers.length / 16);
}

function changed(at: Record<number, number>): number[] {
  return PLAIN.map((entry, i) => at[i] ?? entry);
}

test("stretches are those worked by hand", () => {
  expect(stretchOf(PLAIN)).toEqual({ most: 1, least: 1, isMirrored: false });
  const leant = changed({ 1: 1.5 }); // (1, 1.5; 0, 1): the singular values are 2 and a half
  expect(stretchOf(leant).most).toBeCloseTo(2, 14);
  expect(stretchOf(leant).least).toBeCloseTo(0.5, 14);
  expect(stretchOf(changed({ 0: -3, 10: 0.25 }))).toEqual({ most: 3, least: 0.25, isMirrored: true });
  expect(stretchOf([0, 1, 0, 7, 1, 0, 0, 7, 0, 0, 1, 7]).isMirrored).toBe(true); // two axes change places
  expect(stretchOf([0, 1, 0, 7, 0, 0, 1, 7, 1, 0, 0, 7]).isMirrored).toBe(false);
});

test("of thin, huge and tiny ones it is known too whether they are mirrored", () => {
  for (const unit of [1e-300, 1, 1e300]) {
    for (const thin of [1e-11, -1e-11]) {
      // all but flat, seen from aside: rows of a turn times what leans
      const [c, s] = [0.6 * unit, 0.8 * unit];
      const m = [c, -s * thin, c, 0, s, c * thin, s, 0, 0, 0, unit * thin, 0];
      const { most, least, isMirrored } = stretchOf(m);
      expect(isMirrored).toBe(false); // thin times thin
      expect(most / unit).toBeCloseTo(Math.SQRT2, 12);
      expect(least / unit / 1e-11).toBeCloseTo(Math.SQRT1_2, 3);
      m[10] = -unit * thin;
      expect(stretchOf(m).isMirrored).toBe(true);
    }
  }
});

test("what cannot be turned back, is not finite or of another length is none", () => {
  expect([...read(...PLAIN, ...changed({ 3: 1e9 }))!]).toEqual([...PLAIN, ...changed({ 3: 1e9 })]);
  const wrong = [{ 0: Number.NaN }, { 3: Infinity }, { 12: 1 }, { 15: 2 }, { 5: 0 }, { 10: 1e-13 }];
  for (const at of [...wrong, { 0: 0, 5: 0, 10: 0 }, { 4: 1, 5: 0 }]) expect(read(...changed(at))).toBeNull();
  expect(read(...PLAIN, 0)).toBeNull();
  expect(placementsOf(new Uint8Array(127), 1)).toBeNull();
  expect(read(...changed({ 10: 1e-11 }))).not.toBeNull();
});
