/** Catmull-Clark patches of small control meshes: the same triangles as Python's, to the last bit. */
import { createHash } from "node:crypto";
import { describe, expect, test } from "vitest";
import text from "../../../../spec/golden/slates.json?raw";
import type { DepthRules } from "../../format/cage";
import type { Triple } from "../../format/graph";
import type { PolygonMesh } from "../../format/polygons";
import { parseMessage, SlotBuffers } from "../../format/wire";
import type { Request } from "../dialogue";
import { sessionOf } from "../sessions";
import { Placements } from "./placements";
import { FrameRate } from "./rate";
import { Slates } from "./slates";

interface Step {
  readonly depths?: number[];
  readonly eye?: Triple;
  readonly pixels?: number;
  readonly rules?: string;
  readonly budget?: number | null;
  readonly triangles: number;
  readonly patch_depths: string;
  readonly faces: string;
  readonly rows_changed: string;
  readonly faces_changed: string;
  readonly points: string;
  readonly samples: { readonly rows: number[]; readonly columns: number[][] };
}

interface GoldenMesh {
  readonly positions: number[];
  readonly starts: number[];
  readonly corners: number[];
  readonly crease_edges: number[];
  readonly crease_sharpness: number[];
  readonly corner_vertices: number[];
  readonly corner_sharpness: number[];
  readonly boundary: PolygonMesh["boundary"];
  readonly colours?: number[];
  readonly uvs?: number[];
  readonly holes?: number[];
}

interface Golden {
  readonly rules: Record<string, DepthRules>;
  readonly cages: readonly {
    readonly name: string;
    readonly mesh: GoldenMesh;
    readonly placements?: number[];
    readonly steps: readonly Step[];
  }[];
  readonly rates: readonly {
    readonly rate: number;
    readonly base: number;
    readonly each: number;
    readonly least: number;
    readonly budgets: number[];
  }[];
  readonly session: {
    readonly mesh: GoldenMesh;
    readonly placements: number[];
    readonly origin: Triple;
    readonly messages: readonly {
      readonly request: Request;
      readonly base: number;
      readonly flags: number;
      readonly faces: number;
      readonly vertices: number;
      readonly triangles: number;
      readonly arrays: readonly string[];
    }[];
  };
}

const golden: Golden = JSON.parse(text);

function meshOf(data: GoldenMesh): PolygonMesh {
  return {
    positions: Float64Array.from(data.positions),
    starts: Int32Array.from(data.starts),
    corners: Int32Array.from(data.corners),
    creaseEdges: Int32Array.from(data.crease_edges),
    creaseSharpness: Float32Array.from(data.crease_sharpness),
    cornerVertices: Int32Array.from(data.corner_vertices),
    cornerSharpness: Float32Array.from(data.corner_sharpness),
    boundary: data.boundary,
    colours: data.colours && Float32Array.from(data.colours),
    uvs: data.uvs && Float32Array.from(data.uvs),
    holes: data.holes && Int32Array.from(data.holes),
  };
}

function digest(...arrays: ArrayBufferView[]): string {
  const hash = createHash("sha256");
  for (const { buffer, byteOffset, byteLength } of arrays) {
    hash.update(new Uint8Array(buffer as ArrayBuffer, byteOffset, byteLength));
  }
  return hash.digest("hex");
}

describe.each(golden.cages)("$name", ({ mesh, placements, steps }) => {
  const options = placements ? { placements: new Placements(placements) } : {};
  const surface = new Slates(meshOf(mesh), options);
  test.each(steps.map((step, i) => [i, step] as const))("step %i", (_i, step) => {
    const { blocks, shown } = surface;
    if (step.depths) surface.show(step.depths);
    else surface.update({ eye: step.eye!, pixels: step.pixels! }, golden.rules[step.rules!]!, step.budget);
    expect([...shown.depths].map((d) => (d < 0 ? "." : `${d}`)).join("")).toBe(step.patch_depths);
    expect(shown.triangles).toBe(step.triangles);
    expect(digest(shown.faces.subarray(0, 3 * shown.rows))).toBe(step.faces);
    expect(digest(Uint32Array.from(blocks.changed))).toBe(step.rows_changed);
    expect(digest(Uint32Array.from(shown.changed))).toBe(step.faces_changed);
    const normals = blocks.columns.at(-1)!;
    const [positions, ...others] = blocks.columns.slice(0, -1).map((c) => c.subarray(0, 3 * blocks.rows));
    const columns = [positions!, normals.subarray(0, 3 * blocks.rows), ...others];
    step.samples.columns.forEach((wanted, i) => {
      const seen = step.samples.rows.flatMap((row) => [...columns[i]!.subarray(3 * row, 3 * row + 3)]);
      expect(seen).toEqual(wanted);
    });
    expect(digest(...columns)).toBe(step.points);
  });
});

test("what a page has of places, colours and holes", () => {
  const { mesh, placements, origin, messages } = golden.session;
  const cage = {
    scheme: "catmull-clark",
    mesh: meshOf(mesh),
    placements: Float64Array.from(placements),
  } as const;
  const session = sessionOf(cage, origin, "placed.fov");
  const page = new SlotBuffers();
  for (const { request, arrays, flags, ...told } of messages) {
    const answer = session.answer(request)!;
    const message = parseMessage(answer);
    expect(message).toMatchObject(told);
    expect(new Uint32Array(answer)[3]).toBe(flags);
    page.apply(message);
    const { faces, vertices } = message;
    const held = [
      page.faces.subarray(0, 3 * faces),
      page.positions.subarray(0, 3 * vertices),
      page.starts.subarray(0, 3 * vertices),
      page.tags.subarray(0, 4 * Math.ceil(faces / 4)),
      page.colours.subarray(0, 4 * vertices),
    ];
    expect(held.map((array) => digest(array))).toEqual(arrays);
  }
});

test.each(golden.rates)("a budget for $rate frames a second", ({ rate, base, each, least, budgets }) => {
  const pace = new FrameRate(rate, least, 1_000_000);
  const found = budgets.map((_, i) => {
    const triangles = Math.min(pace.budget, 400_000);
    pace.tell(base + triangles * each * (1 + 0.02 * (i % 3)), triangles);
    return pace.budget;
  });
  expect(found).toEqual(budgets);
});
