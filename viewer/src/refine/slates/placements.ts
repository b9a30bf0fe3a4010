/**
 * Where a surface stands, in one place or in many: matrices from its own space to that of the camera.
 *
 * @module refine/slates/placements
 */
import type { Triple } from "../../format/graph";
import { stretchOf } from "../../format/placements";

const ONE = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

export class Placements {
  readonly count: number;
  /** By how much a length grows, at most. */
  readonly scales: Float64Array;
  readonly #inverses: Float64Array;

  /** @param matrices - Of 16 numbers each, row by row; invertible, the last row 0 0 0 1. */
  constructor(readonly matrices: ArrayLike<number> = ONE) {
    this.count = matrices.length / 16;
    this.scales = new Float64Array(this.count);
    this.#inverses = new Float64Array(12 * this.count);
    for (let i = 0; i < this.count; i++) {
      const m = Array.from({ length: 12 }, (_, j) => matrices[16 * i + j]!);
      this.scales[i] = stretchOf(m).most;
      this.#inverses.set(inverse(m), 12 * i);
    }
  }

  /** A point of the camera's space in that of the surface, as placement i has it. */
  inside(i: number, [x, y, z]: Triple): Triple {
    const m = this.#inverses.subarray(12 * i, 12 * i + 12);
    const row = (j: number) => m[j]! * x + m[j + 1]! * y + m[j + 2]! * z + m[j + 3]!;
    return [row(0), row(4), row(8)];
  }
}

/** Three rows of four, of three rows of four. */
function inverse(m: readonly number[]): number[] {
  const [a, b, c, x, d, e, f, y, g, h, i, z] = m as [
    ...[number, number, number, number],
    ...[number, number, number, number],
    ...[number, number, number, number],
  ];
  const [p, q, r] = [e * i - f * h, f * g - d * i, d * h - e * g];
  const det = a * p + b * q + c * r;
  const rows = [
    [p, c * h - b * i, b * f - c * e],
    [q, a * i - c * g, c * d - a * f],
    [r, b * g - a * h, a * e - b * d],
  ];
  return rows.flatMap((row) => {
    const [u, v, w] = row.map((entry) => entry / det) as [number, number, number];
    return [u, v, w, -(u * x + v * y + w * z)];
  });
}
