import { expect, test } from "vitest";
import { reorder } from "./reorder";

/** A square of n x n vertices, row by row. */
function square(n: number): Uint32Array {
  const out: number[] = [];
  for (let y = 0; y + 1 < n; y++) {
    for (let x = 0; x + 1 < n; x++) {
      const v = y * n + x;
      out.push(v, v + 1, v + n, v + 1, v + n + 1, v + n);
    }
  }
  return Uint32Array.from(out);
}

/** Vertices transformed for each triangle by a first-in-first-out cache. */
function missRatio(indices: Uint32Array, size: number): number {
  const cache: number[] = [];
  let misses = 0;
  for (const v of indices) {
    if (cache.includes(v)) continue;
    misses++;
    cache.push(v);
    if (cache.length > size) cache.shift();
  }
  return misses / (indices.length / 3);
}

function sorted(indices: Uint32Array): string[] {
  const out: string[] = [];
  for (let i = 0; i < indices.length; i += 3) out.push(indices.subarray(i, i + 3).join());
  return out.sort();
}

test("the triangles are the same, corners in their order", () => {
  const odd = Uint32Array.from([0, 1, 2, 2, 1, 0, 0, 1, 2, 5, 5, 7, 6, 6, 6]);
  for (const [indices, vertices] of [
    [square(20), 400],
    [odd, 9],
    [new Uint32Array(0), 0],
    [new Uint32Array(0), 5],
  ] as const) {
    expect(sorted(reorder(indices, vertices))).toEqual(sorted(indices));
  }
});

test("far fewer vertices are transformed twice", () => {
  const rows = square(100); // longer than any cache, so that each row is transformed again for the next
  const better = reorder(rows, 10_000);
  expect(missRatio(rows, 16)).toBeGreaterThan(1);
  expect(missRatio(better, 16)).toBeLessThan(0.75);
  expect(missRatio(better, 32)).toBeLessThan(0.7);
});
