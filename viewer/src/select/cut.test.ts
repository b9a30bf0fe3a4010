/** The selection: the same cuts as Python's, and a few cases worked by hand. */
import { describe, expect, test } from "vitest";
import text from "../../../spec/golden/selection.json?raw";
import type { Graph } from "../format/graph";
import { Selection } from "./cut";
import { setFrustum } from "./frustum";
import { screenError, type View } from "./screenError";

type Vector = readonly [number, number, number];

interface Golden {
  readonly graphs: readonly {
    readonly spheres: number[];
    readonly errors: (number | null)[];
    readonly first_patch: number[];
    readonly finer: number[];
    readonly triangles: number[];
    readonly vertices: number[];
    readonly patch_bytes: number[];
  }[];
  readonly cases: readonly {
    readonly graph: number;
    readonly camera: {
      readonly position: Vector;
      readonly field_of_view: number;
      readonly width: number;
      readonly height: number;
      readonly near: number;
      readonly basis: readonly [Vector, Vector, Vector];
    };
    readonly view: { eye: number[]; pixels_per_radian: number; near: number; planes: number[] };
    readonly options: {
      error_px: number;
      triangle_budget: number | null;
      byte_budget: number | null;
      available: number[] | null;
      is_culling: boolean;
    };
    readonly cut: {
      expanded: number[];
      drawn: number[];
      wanted: number[];
      triangles: number;
      held_bytes: number;
      error_px: number | null;
    };
  }[];
}

const golden: Golden = JSON.parse(text);

function graphOf(columns: Golden["graphs"][number]): Graph {
  return {
    nodes: columns.errors.length,
    patches: columns.finer.length,
    spheres: Float32Array.from(columns.spheres),
    errors: Float32Array.from(columns.errors, (error) => error ?? Number.POSITIVE_INFINITY),
    firstPatch: Uint32Array.from(columns.first_patch),
    finer: Int32Array.from(columns.finer),
    triangles: Uint32Array.from(columns.triangles),
    vertices: Uint32Array.from(columns.vertices),
    patchBytes: Uint32Array.from(columns.patch_bytes),
  };
}

/** Two patches stand for two nodes, the second of which refines a piece of the first's too. */
function small(): Graph {
  return {
    nodes: 3,
    patches: 5,
    spheres: new Float32Array([0, 0, 0, 2, 1, 0, 0, 1, -1, 0, 0, 1]),
    errors: new Float32Array([Number.POSITIVE_INFINITY, 0.5, 0.25]),
    firstPatch: new Uint32Array([0, 2, 4, 5]),
    finer: new Int32Array([1, 2, -1, 2, -1]),
    triangles: new Uint32Array([10, 20, 15, 7, 40]),
    vertices: new Uint32Array([5, 10, 7, 4, 20]),
    patchBytes: new Uint32Array([30, 60, 45, 21, 120]),
  };
}

const everywhere: View = { eye: [0, 0, 0], pixelsPerRadian: 100, near: 0.1, planes: [] };
const nodesOf = (flags: Uint8Array): number[] => [...flags.keys()].filter((node) => flags[node] !== 0);

describe("golden cases", () => {
  const selections = golden.graphs.map((columns) => new Selection(graphOf(columns)));

  test.each(golden.cases.map((one, index) => [index, one] as const))("case %i", (_, one) => {
    const { options, view, cut } = one;
    const selection = selections[one.graph]!;
    const available = new Uint8Array(selection.expanded.length);
    for (const node of options.available ?? []) available[node] = 1;
    selection.select(
      { eye: view.eye, pixelsPerRadian: view.pixels_per_radian, near: view.near, planes: view.planes },
      {
        errorPx: options.error_px,
        isCulling: options.is_culling,
        ...(options.triangle_budget !== null && { triangleBudget: options.triangle_budget }),
        ...(options.byte_budget !== null && { byteBudget: options.byte_budget }),
        ...(options.available !== null && { available }),
      },
    );
    expect(nodesOf(selection.expanded)).toEqual(cut.expanded);
    expect([...selection.drawn.subarray(0, selection.drawnCount)]).toEqual(cut.drawn);
    expect([...selection.wanted.subarray(0, selection.wantedCount)]).toEqual(cut.wanted);
    expect(selection.triangles).toBe(cut.triangles);
    expect(selection.heldBytes).toBe(cut.held_bytes);
    expect(selection.errorPx).toBe(cut.error_px ?? Number.POSITIVE_INFINITY);
  });

  test("frusta are the same to the last few bits", () => {
    for (const { camera, view } of golden.cases) {
      const planes = new Float64Array(20);
      const tanY = Math.tan(camera.field_of_view / 2);
      const tanX = (tanY * camera.width) / camera.height;
      setFrustum(planes, camera.position, ...camera.basis, tanX, tanY, camera.near);
      planes.forEach((value, i) => {
        expect(value).toBeCloseTo(view.planes[i]!, 10);
      });
    }
  });
});

describe("by hand", () => {
  test("an error of half a unit at five units from the sphere, 100 pixels a radian, is ten pixels", () => {
    expect(screenError(0.5, 3, 4, 12, 8, everywhere)).toBe(10);
    expect(screenError(0.5, 0, 0, 8.001, 8, everywhere)).toBe((100 * 0.5) / 0.1); // nearer than near
    expect(screenError(0.5, 0, 0, 7, 8, everywhere)).toBe(Number.POSITIVE_INFINITY);
    expect(screenError(0, 0, 0, 7, 8, everywhere)).toBe(0);
  });

  test("refining hides what is refined, also in a parent's sibling", () => {
    const selection = new Selection(small());
    selection.select(everywhere, { errorPx: 1 });
    expect([...selection.drawn.subarray(0, selection.drawnCount)]).toEqual([2, 4]);
    expect(selection.triangles).toBe(55);
  });

  test("a node waits for all its parents, and both are wanted, the coarser first", () => {
    const selection = new Selection(small());
    selection.select(everywhere, { errorPx: 1, available: new Uint8Array([1, 0, 1]) });
    expect([...selection.drawn.subarray(0, selection.drawnCount)]).toEqual([0, 1]);
    expect([...selection.wanted.subarray(0, selection.wantedCount)]).toEqual([1]);
    selection.select(everywhere, { errorPx: 1, available: new Uint8Array(3) });
    expect(selection.drawnCount).toBe(0);
    expect([...selection.wanted.subarray(0, selection.wantedCount)]).toEqual([0, 1, 2]);
    expect(selection.errorPx).toBe(Number.POSITIVE_INFINITY);
  });

  test("a budget counts what is shown, and stops where it would be broken", () => {
    const selection = new Selection(small());
    for (const [budget, shown] of [
      [0, 30],
      [41, 30],
      [42, 42],
      [54, 42],
      [55, 55],
    ] as const) {
      selection.select(everywhere, { errorPx: 1, triangleBudget: budget });
      expect(selection.triangles).toBe(shown);
    }
  });

  test("the byte budget counts what the caller says a node holds", () => {
    const selection = new Selection(small(), Float64Array.of(1000, 2000, 3000));
    selection.select(everywhere, { errorPx: 1, byteBudget: 5999 });
    expect(nodesOf(selection.expanded)).toEqual([0, 1]);
    expect(selection.heldBytes).toBe(3000);
  });
});
