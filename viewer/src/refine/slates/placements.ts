/**
 * Where a surface stands, in one place or in many: matrices from its own space to that of the camera.
 *
 * @module refine/slates/placements
 */
import type { Triple } from "../../format/graph";

const ONE = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const SWEEPS = 30;

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
      this.scales[i] = largest(m);
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

/** The largest singular value of the left three columns, by turning their products until they are diagonal. */
function largest(m: readonly number[]): number {
  const dot = (a: number, b: number) => m[a]! * m[b]! + m[a + 4]! * m[b + 4]! + m[a + 8]! * m[b + 8]!;
  const s = [0, 1, 2].map((a) => [0, 1, 2].map((b) => dot(a, b)));
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    for (const [p, q] of [
      [0, 1],
      [0, 2],
      [1, 2],
    ] as const) {
      if (s[p]![q] !== 0) rotate(s, p, q);
    }
  }
  return Math.sqrt(Math.max(s[0]![0]!, s[1]![1]!, s[2]![2]!));
}

/** Jacobi's rotation that makes entry (p, q) zero. */
function rotate(s: number[][], p: number, q: number): void {
  const theta = (s[q]![q]! - s[p]![p]!) / (2 * s[p]![q]!);
  const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.sqrt(theta * theta + 1));
  const c = 1 / Math.sqrt(t * t + 1);
  const turned = (a: number, b: number): [number, number] => [c * a - t * c * b, t * c * a + c * b];
  for (const row of s) [row[p], row[q]] = turned(row[p]!, row[q]!);
  for (let k = 0; k < 3; k++) [s[p]![k], s[q]![k]] = turned(s[p]![k]!, s[q]![k]!);
}
