/** Where the polygons of a `.fov` of kind `cage` stand: matrices in chunk 1 (spec/container.md). */

/** Of the largest stretch: what is thinner counts as flat. */
const FLAT = 1e-12;
const SWEEPS = 30;
const PAIRS = [
  [0, 1],
  [0, 2],
  [1, 2],
] as const;

/** Matrices of 16 numbers, row by row; null if they are not so many, or one is no placement. */
export function placementsOf(chunk: Uint8Array, count: number): Float64Array | null {
  if (chunk.length !== 128 * count) return null;
  const matrices = new Float64Array(chunk.slice().buffer);
  for (let at = 0; at < matrices.length; at += 16) {
    if (!isPlacement(matrices.subarray(at, at + 16))) return null;
  }
  return matrices;
}

function isPlacement(m: Float64Array): boolean {
  if (!m.every(Number.isFinite) || m[12] !== 0 || m[13] !== 0 || m[14] !== 0 || m[15] !== 1) return false;
  const { most, least } = stretchOf(m);
  return least > FLAT * most;
}

/** What a matrix does to lengths, and whether it turns the inside out. */
export interface Stretch {
  /** A length grows by so much, at most and at least: the singular values. */
  readonly most: number;
  readonly least: number;
  readonly isMirrored: boolean;
}

/**
 * Of the left three columns, turned until they are at right angles (Hestenes 1958): then their lengths are what is
 * wanted, and on which side of the others the third is, is sure, however thin the matrix.
 */
export function stretchOf(m: ArrayLike<number>): Stretch {
  const unit = Math.max(...[0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => Math.abs(m[i]!)));
  const columns = [0, 1, 2].map((x) => [m[x]! / unit, m[4 + x]! / unit, m[8 + x]! / unit]);
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    for (const [p, q] of PAIRS) turn(columns[p]!, columns[q]!);
  }
  const lengths = columns.map((column) => Math.sqrt(dot(column, column)));
  const [a, b, c] = columns.map((column, x) => column.map((entry) => entry / lengths[x]!)) as [
    number[],
    number[],
    number[],
  ];
  const across = [
    a[1]! * b[2]! - a[2]! * b[1]!,
    a[2]! * b[0]! - a[0]! * b[2]!,
    a[0]! * b[1]! - a[1]! * b[0]!,
  ];
  return {
    most: unit * Math.max(...lengths),
    least: unit * Math.min(...lengths),
    isMirrored: dot(across, c) < 0,
  };
}

/** Turn two columns in their plane, so that they are at right angles. */
function turn(a: number[], b: number[]): void {
  const shared = dot(a, b);
  if (shared === 0) return;
  const theta = (dot(b, b) - dot(a, a)) / (2 * shared);
  const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.sqrt(theta * theta + 1));
  const c = 1 / Math.sqrt(t * t + 1);
  for (let x = 0; x < 3; x++) {
    const [u, v] = [a[x]!, b[x]!];
    a[x] = c * u - t * c * v;
    b[x] = t * c * u + c * v;
  }
}

function dot(a: readonly number[], b: readonly number[]): number {
  return a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
}
