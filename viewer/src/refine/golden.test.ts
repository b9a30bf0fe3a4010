/** Refinements of small control meshes: the same triangles as Python's, to the last bit. */
import { createHash } from "node:crypto";
import { describe, expect, test } from "vitest";
import sharpText from "../../../spec/golden/sharp.json?raw";
import text from "../../../spec/golden/sqrt3.json?raw";
import type { Criteria } from "../format/cage";
import type { WireCamera } from "../stream/refinement";
import { COARSEST, coarser, Pace } from "./pace";
import { Sqrt3 } from "./sqrt3";
import { turn } from "./turn";
import { limitsOf, viewOf } from "./view";

interface Step {
  readonly camera: WireCamera;
  readonly view: number[];
  readonly criteria: string;
  readonly slices: number | null;
  readonly faces: number;
  readonly vertices: number;
  readonly control: string;
  readonly limit: string;
  readonly starts: string;
  readonly rows?: number[][];
}

interface GoldenCage {
  readonly positions: number[];
  readonly faces: number[];
  /** Pairs of vertices, of those with sharp edges. */
  readonly sharp?: number[];
}

interface Walk {
  readonly cage: string;
  readonly steps: readonly Step[];
}

interface Golden {
  readonly turns: [i: number, n: number, cosine: number, sine: number][];
  readonly cages: Record<string, GoldenCage>;
  readonly criteria: Record<string, Criteria & { limits: number[] }>;
  readonly walks: readonly Walk[];
  readonly coarsest: number;
  readonly searches: { readonly edge_px: number; readonly views: readonly SearchedView[] }[];
}

interface SearchedView {
  readonly top: number;
  readonly budget: number;
  readonly rate: number;
  readonly is_leap: boolean;
  readonly is_moving: boolean;
  readonly allowed: number;
  readonly steps: number[];
  readonly limits: number[];
}

const golden: Golden = JSON.parse(text);
const sharp: Pick<Golden, "cages" | "walks"> = JSON.parse(sharpText);
const PLACES = ["control", "limit", "starts"] as const;

test.each(golden.turns)("the cosine and sine of %i / %i of a turn", (i, n, cosine, sine) => {
  expect(turn(i, n)).toEqual([cosine, sine]);
});

test.each(Object.entries(golden.criteria))(
  "the numbers of the criteria %s",
  (_name, { limits, ...criteria }) => {
    expectClose(limitsOf(criteria), limits);
  },
);

function meshOf({ positions, faces, sharp: edges }: GoldenCage) {
  return {
    positions: Float64Array.from(positions),
    faces: Int32Array.from(faces),
    sharp: edges && Int32Array.from(edges),
  };
}

const COLUMNS = 10;

/** Where vertices are, go or were born: ten numbers a triangle, the least corner first, sorted. */
function rowsOf(refined: Sqrt3, what: (typeof PLACES)[number]): Float64Array {
  const shown = refined.faces();
  const places = new Float64Array(3 * refined.vertexSlots);
  for (let v = 0; v < refined.vertexSlots; v++) {
    if (what === "starts") refined.start(v, places, 3 * v);
    else refined.place(v, what === "limit", shown, places, 3 * v);
  }
  const rows = new Float64Array(COLUMNS * shown.levels.length);
  let count = 0;
  for (let f = 0; f < shown.levels.length; f++) {
    const face = shown.faces.subarray(3 * f, 3 * f + 3);
    if (face[0] === face[1]) continue; // free
    let first = 0;
    for (const k of [1, 2]) if (compare(places, 3 * face[k]!, 3 * face[first]!, 3) < 0) first = k;
    for (let i = 0; i < 9; i++) {
      rows[COLUMNS * count + i] = places[3 * face[(first + Math.floor(i / 3)) % 3]! + (i % 3)]! + 0;
    }
    rows[COLUMNS * count++ + 9] = shown.levels[f]!;
  }
  const order = Int32Array.from({ length: count }, (_, i) => COLUMNS * i).sort((a, b) =>
    compare(rows, a, b, COLUMNS),
  );
  const sorted = new Float64Array(COLUMNS * count);
  order.forEach((at, i) => {
    sorted.set(rows.subarray(at, at + COLUMNS), COLUMNS * i);
  });
  return sorted;
}

/** Numbers from a against those from b. */
function compare(values: Float64Array, a: number, b: number, count: number): number {
  for (let i = 0; i < count; i++) if (values[a + i] !== values[b + i]) return values[a + i]! - values[b + i]!;
  return 0;
}

function digest(rows: Float64Array): string {
  return createHash("sha256").update(new Uint8Array(rows.buffer)).digest("hex");
}

function expectClose(found: ArrayLike<number>, wanted: ArrayLike<number>): void {
  expect(found.length).toBe(wanted.length);
  const scale = Math.max(1, ...Array.from(wanted, Math.abs));
  for (let i = 0; i < wanted.length; i++)
    expect(Math.abs(found[i]! - wanted[i]!)).toBeLessThan(1e-12 * scale);
}

const walks = [golden, sharp].flatMap(({ cages, walks: some }) =>
  some.map(({ cage, steps }) => ({
    cage,
    steps,
    mesh: meshOf(cages[cage]!),
    isSharp: cages === sharp.cages,
  })),
);

describe.each(walks)("a walk around $cage, sharp: $isSharp", ({ cage, steps, mesh }) => {
  const walking = new Sqrt3(mesh, cage);
  test.each(steps)("$criteria: $faces faces", (step) => {
    const view = Float64Array.from(step.view);
    const limits = Float64Array.from(golden.criteria[step.criteria]!.limits);
    expectClose(viewOf(step.camera), view);
    for (;;) if (walking.update(view, limits, step.slices ?? Infinity).isDone) break;
    const fresh = new Sqrt3(mesh, cage);
    const { faces, vertices } = fresh.update(view, limits);
    expect([faces, vertices]).toEqual([step.faces, step.vertices]);
    for (const what of PLACES) {
      const rows = rowsOf(walking, what);
      if (what === "control" && step.rows) expect([...rows]).toEqual(step.rows.flat());
      expect(digest(rows)).toBe(step[what]);
    }
    expect(digest(rowsOf(fresh, "control"))).toBe(step.control);
  });
});

test("the coarsest threshold", () => expect(COARSEST).toBe(golden.coarsest));

test.each(golden.searches)("the search for a threshold, from $edge_px pixels", ({ edge_px, views }) => {
  const region = (iterations: number, edge: number) => ({ iterations, edge_px: edge, bend: 0 });
  const criteria = { front: region(6, edge_px), silhouette: region(8, edge_px / 2), back: region(0, 0) };
  const search = new Pace(12, 2_000_000);
  for (const view of views) {
    search.spent(4e-4);
    search.begin(criteria, { budget: view.budget, rate: view.rate, isLeap: view.is_leap });
    const steps: number[] = [];
    while (!(view.is_moving ? search.isFit : search.isSettled)) {
      if (search.isFit) search.finer();
      steps.push(search.step);
      search.tell(Math.max(12, Math.floor(view.top / 2 ** (search.step / 4))));
    }
    expect(steps).toEqual(view.steps);
    expect(search.budget).toBe(view.allowed);
    expect([...limitsOf(coarser(criteria, search.step))]).toEqual(view.limits);
  }
});
