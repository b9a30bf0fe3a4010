import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { parseCage, refinementOf } from "./cage";
import { headLength, parseContainer } from "./container";

const REGION = { iterations: 3, edge_px: 5, bend_degrees: 90 };
const HEADER = {
  kind: "cage",
  version: 1,
  first_bytes: 0,
  origin: [1, 2, 3],
  box: [
    [0, 1, 2],
    [2, 3, 4],
  ],
  up: "z",
  vertices: 4,
  triangles: 4,
  scheme: "loop",
  criteria: { front: REGION, silhouette: REGION, back: REGION },
  positions: "limit",
  budget: 1000,
  rate: 25,
};

describe("a control mesh's header", () => {
  it("is, in the golden file, what was written", () => {
    const golden = new URL("../../../spec/golden/", import.meta.url);
    const file = new Uint8Array(readFileSync(new URL("cage.fov", golden)));
    const { positions, faces, up, shown, ...rest } = JSON.parse(
      readFileSync(new URL("cage.json", golden), "utf8"),
    );
    const head = file.subarray(0, headLength(file, "cage.fov"));
    const info = parseCage(parseContainer(head, "cage.fov", file.length).header, "cage.fov");
    expect(info).toMatchObject({ up, vertices: positions.length, triangles: faces.length });
    const { criteria, ...others } = rest;
    expect(info.refinement).toMatchObject({ ...others, positions: shown });
    for (const region of ["front", "silhouette", "back"] as const) {
      const { bend, ...limits } = info.refinement.criteria[region];
      expect(limits).toEqual({ iterations: criteria[region].iterations, edge_px: criteria[region].edge_px });
      expect(bend).toBeCloseTo(criteria[region].bend, 14);
    }
    const columns = [0, 1, 2].map((a) => positions.map((p: number[]) => p[a]!));
    expect(info.box).toEqual([columns.map((c) => Math.min(...c)), columns.map((c) => Math.max(...c))]);
    expect(info.origin).toEqual(columns.map((c) => 0.5 * Math.min(...c) + 0.5 * Math.max(...c)));
  });

  it("is, in the golden file of polygons, what was written", () => {
    const golden = new URL("../../../spec/golden/", import.meta.url);
    const file = new Uint8Array(readFileSync(new URL("cage_polygons.fov", golden)));
    const { positions, starts, up, depths, budget, rate } = JSON.parse(
      readFileSync(new URL("cage_polygons.json", golden), "utf8"),
    );
    const head = file.subarray(0, headLength(file, "a.fov"));
    const { header } = parseContainer(head, "a.fov", file.length);
    const info = parseCage(header, "a.fov");
    expect(info).toMatchObject({ up, vertices: positions.length, polygons: starts.length - 1 });
    expect(info.refinement).toMatchObject({ scheme: "catmull-clark", depths, budget, rate });
    for (const faces of [undefined, 0, 1.5, "7", null]) {
      expect(() => parseCage({ ...header, faces }, "a.fov")).toThrow("a.fov");
    }
  });

  it("has the usual depths where it says none that make sense", () => {
    const { depths } = parseCage({ ...HEADER, scheme: "catmull-clark" }, "a.fov").refinement;
    expect(depths).toMatchObject({ most: 5, cone_degrees: 8, size_px: [3, 24] });
    const odd = { most: 99, cone_degrees: "8", backs: 0, silhouettes: null, epsilon: -1, size_px: [3, 5] };
    for (const wrong of [odd, 3, null, "most"]) {
      expect(refinementOf({ depths: wrong }, "scene.json").depths).toEqual(depths);
    }
    const none = refinementOf({ depths: { cone_degrees: null, size_px: null, backs: false } }, "scene.json");
    expect(none.depths).toEqual({ ...depths, cone_degrees: null, size_px: null, backs: false });
  });

  it("has its sharp edges, which are pairs of vertices", () => {
    expect(parseCage({ ...HEADER, sharp_edges: [0, 1, 3, 2] }, "a.fov").sharpEdges).toEqual([0, 1, 3, 2]);
    for (const wrong of [[0], [0, 4], [-1, 0], [0, 1.5], "01", null, [[0, 1]]]) {
      expect(() => parseCage({ ...HEADER, sharp_edges: wrong }, "a.fov")).toThrow("a.fov");
    }
  });

  it("is read", () => {
    const { refinement, ...rest } = parseCage(HEADER, "a.fov");
    expect(rest).toEqual({
      origin: [1, 2, 3],
      box: HEADER.box,
      up: "z",
      triangles: 4,
      vertices: 4,
      sharpEdges: [],
    });
    expect(refinement).toMatchObject({ scheme: "loop", positions: "limit", budget: 1000, rate: 25 });
    expect(refinement.criteria.front).toEqual({ iterations: 3, edge_px: 5, bend: Math.PI / 2 });
  });

  it("is refused with a sentence where it is of another version or damaged", () => {
    expect(() => parseCage({ ...HEADER, version: 3 }, "a.fov")).toThrow(/^a.fov has version 3/);
    expect(() => parseCage({ ...HEADER, scheme: "doo" }, "a.fov")).toThrow(/^a.fov is refined by "doo"/);
    for (const key of ["origin", "box", "vertices", "triangles"]) {
      for (const value of [undefined, null, 3.5, "x", [1, 2], [[1, 2, 3]], [1, 2, Number.NaN]]) {
        expect(() => parseCage({ ...HEADER, [key]: value }, "a.fov"), key).toThrow(/a.fov/);
      }
    }
  });

  it("gives way to what scene.json says, key by key, as far as that makes sense", () => {
    const { refinement } = parseCage(HEADER, "a.fov");
    expect(refinementOf({}, "scene.json", refinement)).toEqual(refinement);
    const layer = {
      criteria: { front: { iterations: 6 }, back: { edge_px: -1, iterations: 1e9, bend_degrees: "7" } },
      positions: "control",
      budget: Number.NaN,
      rate: 10,
    };
    const mixed = refinementOf(layer, "scene.json", refinement);
    expect(mixed.criteria.front).toEqual({ ...refinement.criteria.front, iterations: 6 });
    expect(mixed.criteria.back).toEqual(refinement.criteria.back);
    expect(mixed).toMatchObject({ scheme: "loop", positions: "control", budget: 1000, rate: 10 });
    for (const odd of [{ criteria: 3 }, { criteria: null }, { positions: 1, rate: {} }]) {
      expect(refinementOf(odd, "scene.json", refinement)).toEqual(refinement);
    }
  });
});
