/** Refinements of small control meshes: the same triangles as Python's, to the last bit. */
import { createHash } from "node:crypto";
import { describe, expect, test } from "vitest";
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

interface Golden {
  readonly turns: [i: number, n: number, cosine: number, sine: number][];
  readonly cages: Record<string, { positions: number[]; faces: number[] }>;
  readonly criteria: Record<string, Criteria & { limits: number[] }>;
  readonly walks: { readonly cage: string; readonly steps: Step[] }[];
  readonly coarsest: number;
  readonly paces: {
    top: number;
    budget: number;
    rate: number;
    is_leap: boolean;
    edge_px: number;
    steps: number[];
    limits: number[];
  }[];
}

const golden: Golden = JSON.parse(text);
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

function meshOf(name: string) {
  const { positions, faces } = golden.cages[name]!;
  return { positions: Float64Array.from(positions), faces: Int32Array.from(faces) };
}

/** Where vertices are, go or were born: ten numbers a triangle, the least corner first, sorted. */
function rowsOf(refined: Sqrt3, what: (typeof PLACES)[number]): number[][] {
  const shown = refined.faces();
  const places = new Float64Array(3 * refined.vertexSlots);
  for (let v = 0; v < refined.vertexSlots; v++) {
    if (what === "starts") refined.start(v, places, 3 * v);
    else refined.place(v, what === "limit", shown, places, 3 * v);
  }
  const rows: number[][] = [];
  for (let f = 0; f < shown.levels.length; f++) {
    const face = [...shown.faces.subarray(3 * f, 3 * f + 3)];
    if (face.every((v) => v === 0)) continue;
    const corners = face.map((v) => [...places.subarray(3 * v, 3 * v + 3)].map((x) => x + 0));
    const first = [0, 1, 2].sort((a, b) => compare(corners[a]!, corners[b]!))[0]!;
    rows.push([...[0, 1, 2].flatMap((k) => corners[(first + k) % 3]!), shown.levels[f]!]);
  }
  return rows.sort(compare);
}

function compare(a: number[], b: number[]): number {
  for (let i = 0; i < a.length; i++) if (a[i] !== b[i]) return a[i]! - b[i]!;
  return 0;
}

function digest(rows: number[][]): string {
  return createHash("sha256")
    .update(new Uint8Array(Float64Array.from(rows.flat()).buffer))
    .digest("hex");
}

function expectClose(found: ArrayLike<number>, wanted: ArrayLike<number>): void {
  expect(found.length).toBe(wanted.length);
  const scale = Math.max(1, ...Array.from(wanted, Math.abs));
  for (let i = 0; i < wanted.length; i++)
    expect(Math.abs(found[i]! - wanted[i]!)).toBeLessThan(1e-12 * scale);
}

describe.each(golden.walks)("a walk around $cage", ({ cage, steps }) => {
  const walking = new Sqrt3(meshOf(cage), cage);
  test.each(steps)("$criteria: $faces faces", (step) => {
    const view = Float64Array.from(step.view);
    const limits = Float64Array.from(golden.criteria[step.criteria]!.limits);
    expectClose(viewOf(step.camera), view);
    for (;;) if (walking.update(view, limits, step.slices ?? Infinity).isDone) break;
    const fresh = new Sqrt3(meshOf(cage), cage);
    const { faces, vertices } = fresh.update(view, limits);
    expect([faces, vertices]).toEqual([step.faces, step.vertices]);
    for (const what of PLACES) {
      const rows = rowsOf(walking, what);
      if (what === "control" && step.rows) expect(rows).toEqual(step.rows);
      expect(digest(rows)).toBe(step[what]);
      expect(digest(rowsOf(fresh, what))).toBe(step[what]);
    }
  });
});

test("the coarsest threshold", () => expect(COARSEST).toBe(golden.coarsest));

test.each(golden.paces)("the threshold for $top triangles, $budget allowed, $rate a second", (pace) => {
  const region = (iterations: number, edge_px: number) => ({ iterations, edge_px, bend: 0 });
  const criteria = {
    front: region(6, pace.edge_px),
    silhouette: region(8, pace.edge_px / 2),
    back: region(0, 0),
  };
  const search = new Pace(2_000_000);
  search.spent(20, 50_000);
  search.begin(criteria, { budget: pace.budget, rate: pace.rate, isLeap: pace.is_leap });
  const steps: number[] = [];
  while (!search.isSettled) {
    steps.push(search.step);
    search.tell(Math.max(12, Math.floor(pace.top / 2 ** (search.step / 4))));
    if (search.isFit && !search.isSettled) search.finer();
  }
  expect(steps).toEqual(pace.steps);
  expect([...limitsOf(coarser(criteria, search.step))]).toEqual(pace.limits);
});
