/** Sessions of Catmull-Clark patches: what comes out, applied as a server's messages are, is the tessellation. */
import { expect, test } from "vitest";
import { USUAL_DEPTHS } from "../format/cage";
import type { PolygonMesh } from "../format/polygons";
import { Problem } from "../format/problem";
import { parseMessage, SlotBuffers, type WireMessage } from "../format/wire";
import type { WireCamera } from "../stream/refinement";
import type { Request } from "./dialogue";
import { PatchSession } from "./patchSession";
import { sessionOf } from "./sessions";
import { Slates } from "./slates/slates";

const ORIGIN = [0.25, -0.5, 0] as const;
const FINE = { ...USUAL_DEPTHS, most: 3, size_px: [4, 16] as const };

/** A closed ring of quadrangles, some edges of it sharp. */
function torus(rings: number, sides: number, scale = 1): PolygonMesh {
  const positions = new Float64Array(3 * rings * sides);
  const corners: number[] = [];
  const at = (i: number, j: number) => (i % rings) * sides + (j % sides);
  for (let i = 0; i < rings; i++) {
    for (let j = 0; j < sides; j++) {
      const [a, b] = [(2 * Math.PI * i) / rings, (2 * Math.PI * j) / sides];
      const out = 1 + 0.4 * Math.cos(b);
      const place = [out * Math.cos(a) + 0.25, 0.4 * Math.sin(b) - 0.5, out * Math.sin(a)];
      positions.set(
        place.map((x) => scale * x),
        3 * at(i, j),
      );
      corners.push(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  const edges = Array.from({ length: rings - 1 }, (_, i) => [at(i, 0), at(i + 1, 0)]);
  return {
    positions,
    starts: Int32Array.from({ length: rings * sides + 1 }, (_, f) => 4 * f),
    corners: Int32Array.from(corners),
    creaseEdges: Int32Array.from(edges.flat()),
    creaseSharpness: Float32Array.from(edges, (_, i) => (i % 3 === 0 ? 1.5 : 10)),
    cornerVertices: new Int32Array(0),
    cornerSharpness: new Float32Array(0),
    boundary: "edge_only",
  };
}

function cameraAt(angle: number, away = 4): WireCamera {
  const position = [0.25 + away * Math.cos(angle), 0.3 * away, away * Math.sin(angle)] as const;
  return { position, target: ORIGIN, up: [0, 1, 0], fov: 0.7, width: 900, height: 700, near: 0.01, far: 100 };
}

/** A page in few words: it applies what comes, and acknowledges it. */
class Page {
  readonly slots = new SlotBuffers();
  #now = 0;
  /** Each look at the clock is so much later. */
  tick = 0;
  readonly session: PatchSession;

  constructor(
    readonly mesh = torus(14, 9),
    mostRows?: number,
  ) {
    const clock = () => {
      this.#now += this.tick;
      return this.#now;
    };
    this.session = new PatchSession(mesh, ORIGIN, "torus.fov", clock, mostRows);
  }

  ask(wish: Partial<Request>): WireMessage | null {
    const request: Request = {
      camera: cameraAt(0),
      criteria: null as never,
      depths: FINE,
      budget: 0,
      positions: "control",
      rate: 0,
      drawn_ms: 5,
      seen: this.slots.sequence,
      ...wish,
    };
    const answer = this.session.answer(request);
    if (!answer) return null;
    const message = parseMessage(answer);
    this.slots.apply(message);
    return message;
  }

  get triangles(): string[] {
    const { slots } = this;
    return trianglesOf(
      slots.faces.subarray(0, 3 * slots.faceCount),
      slots.positions,
      slots.starts,
      slots.tags,
    );
  }
}

type Numbers = ArrayLike<number> & { subarray(begin: number, end: number): ArrayLike<number> };

/** With place and normal of each corner, and the depth; sorted. */
function trianglesOf(faces: Uint32Array, positions: Numbers, normals: Numbers, levels: Uint8Array): string[] {
  const out: string[] = [];
  const row = (column: Numbers, v: number) => Array.from(column.subarray(3 * v, 3 * v + 3)).join();
  for (let i = 0; i < faces.length; i += 3) {
    if (faces[i] === faces[i + 1]) continue;
    const corners = [...faces.subarray(i, i + 3)].map((v) => `${row(positions, v)} ${row(normals, v)}`);
    out.push(`${corners.join(" ")} ${levels[i / 3]}`);
  }
  return out.sort();
}

function fresh(mesh: PolygonMesh, camera: WireCamera, budget: number | null = null): string[] {
  const positions = mesh.positions.map((p, i) => p - ORIGIN[i % 3]!);
  const surface = new Slates({ ...mesh, positions }, { isSingle: true });
  const eye = camera.position.map((p, i) => p - ORIGIN[i]!) as [number, number, number];
  surface.update({ eye, pixels: camera.height / (2 * Math.tan(camera.fov / 2)) }, FINE, budget);
  const [positionRows, normals] = [surface.blocks.columns[0]!, surface.blocks.columns.at(-1)!];
  return trianglesOf(surface.shown.faces, positionRows, normals, surface.shown.levels);
}

test("a walk shows what a fresh tessellation shows, in messages of what changed", () => {
  const page = new Page();
  const lengths: number[] = [];
  for (const [angle, away] of [
    [0, 4],
    [0.3, 4],
    [0.31, 4],
    [2, 2],
    [2, 20],
    [0.3, 4],
  ]) {
    const camera = cameraAt(angle!, away);
    const message = page.ask({ camera })!;
    expect([message.isSettled, message.hasNormals, message.threshold]).toEqual([true, true, 1]);
    expect(message.base).toBe(message.sequence - 1);
    expect(page.triangles).toEqual(fresh(page.mesh, camera));
    lengths.push(message.ranges.flat().reduce((sum, { bytes }) => sum + bytes.length, 0));
  }
  expect(lengths[2]).toBeLessThan(lengths[0]! / 4);
});

test("who asks twice is answered once, and from nothing if all was lost", () => {
  const page = new Page();
  page.ask({});
  expect(page.ask({})).toBeNull();
  const before = page.triangles;
  expect(page.ask({ seen: 0 })!.base).toBe(0);
  expect(page.triangles).toEqual(before);
  page.ask({ camera: cameraAt(1) });
  expect(page.ask({ camera: cameraAt(1.5), seen: 1 })!.base).toBe(0); // a message was lost
  expect(page.triangles).toEqual(fresh(page.mesh, cameraAt(1.5)));
});

test("a budget is kept, and a rate has fewer triangles than none", () => {
  const page = new Page();
  const free = page.ask({})!.triangles;
  const less = page.ask({ budget: free >> 1 })!.triangles;
  expect(less).toBeLessThanOrEqual(free >> 1);
  expect(less).toBeGreaterThan(free >> 2);
  expect(page.triangles).toEqual(fresh(page.mesh, cameraAt(0), free >> 1));
  page.tick = 30;
  for (let i = 0; i < 12; i++) page.ask({ camera: cameraAt(i / 100), rate: 20, drawn_ms: 40 });
  expect(page.ask({ rate: 20 })!.triangles).toBeLessThan(free);
});

test("what was kept for views long ago is forgotten, and all is told anew", () => {
  const page = new Page(torus(14, 9), 1);
  const bases: number[] = [];
  for (const [angle, away] of [
    [0, 60],
    [2, 1.5],
    [4, 1.5],
    [5, 60],
    [5.1, 60],
    [0.3, 1.5],
  ]) {
    const camera = cameraAt(angle!, away);
    bases.push(page.ask({ camera })!.base);
    expect(page.triangles).toEqual(fresh(page.mesh, camera));
  }
  expect(bases.slice(1).filter((base) => base === 0).length).toBeGreaterThan(0);
  expect(bases.slice(1).filter((base) => base > 0).length).toBeGreaterThan(0);
});

/** Of two that are as near the even one. */
function nearest(value: number): number {
  return value % 1 === 0.5 ? 2 * Math.round(value / 2) : Math.round(value);
}

test("colours go with their vertices, to the nearest byte, and are not there without", () => {
  const mesh = torus(14, 9);
  const colours = Float32Array.from(mesh.positions, (_, i) => (i % 3 === 1 ? 0.5 : (7 * i) % 256));
  const page = new Page({ ...mesh, colours, uvs: new Float32Array((2 * colours.length) / 3) });
  const plain = new Page(mesh);
  for (const [angle, away] of [
    [0, 4],
    [1, 2],
    [4, 3],
    [4, 30],
  ]) {
    const camera = cameraAt(angle!, away);
    expect(page.ask({ camera })!.hasColours).toBe(true);
    expect(plain.ask({ camera })!.hasColours).toBe(false);
    expect(page.triangles).toEqual(plain.triangles);
    const positions = mesh.positions.map((p, i) => p - ORIGIN[i % 3]!);
    const surface = new Slates({ ...mesh, positions, colours }, { isSingle: true });
    const eye = camera.position.map((p, i) => p - ORIGIN[i]!) as [number, number, number];
    surface.update({ eye, pixels: camera.height / (2 * Math.tan(camera.fov / 2)) }, FINE);
    const wanted = new Map<string, string>();
    const row = (column: Numbers, v: number) => Array.from(column.subarray(3 * v, 3 * v + 3));
    for (const v of surface.shown.faces) {
      const [place, colour, normal] = surface.blocks.columns.map((column) => row(column, v));
      wanted.set(`${place} ${normal}`, `${colour!.map(nearest)},255`);
    }
    const { slots } = page;
    for (const v of slots.faces.subarray(0, 3 * slots.faceCount)) {
      if (v === 0) continue;
      const seen = [...slots.colours.subarray(4 * v, 4 * v + 4)];
      const key = `${row(slots.positions, v)} ${row(slots.starts, v)}`;
      expect(`${seen}`).toBe(wanted.get(key));
    }
  }
  expect(plain.slots.colours.length).toBe(0);
});

test("an odd mesh is refused in a sentence", () => {
  const mesh = torus(4, 3);
  expect(() => new PatchSession(torus(4, 3, 1e39), [0, 0, 0], "far.fov")).toThrow("far.fov is too large");
  const cases: [string, Partial<PolygonMesh>][] = [
    ["face 0 has vertex 0 twice", { corners: mesh.corners.map((v, i) => (i === 2 ? 0 : v)) }],
    ["face opposite sides", { corners: mesh.corners.map((v, i) => (i < 4 ? mesh.corners[3 - i]! : v)) }],
    [
      "more than two faces",
      {
        corners: Int32Array.of(...mesh.corners, 0, 1, 2),
        starts: Int32Array.of(...mesh.starts, mesh.corners.length + 3),
      },
    ],
    [
      "the edge between vertices 0 and 7 is to be sharp, and there is none",
      { creaseEdges: Int32Array.of(0, 7), creaseSharpness: Float32Array.of(1) },
    ],
    [
      "at vertex 0 several fans of faces touch",
      {
        corners: Int32Array.of(0, 1, 2, 0, 3, 4),
        starts: Int32Array.of(0, 3, 6),
        creaseEdges: new Int32Array(0),
      },
    ],
  ];
  for (const [sentence, odd] of cases) {
    const make = () => new PatchSession({ ...mesh, ...odd }, ORIGIN, "odd.fov");
    expect(make).toThrow(Problem);
    expect(make).toThrow("odd.fov");
    expect(make).toThrow(sentence);
  }
});

test("more patches than a page shows are refused before they are made", () => {
  const placements = new Float64Array(16 * 40_000);
  for (let i = 0; i < placements.length; i++) placements[i] = i % 5 === 0 ? 1 : 0;
  const cage = { scheme: "catmull-clark", mesh: torus(14, 9), placements } as const;
  expect(() => sessionOf(cage, ORIGIN, "many.fov")).toThrow("many.fov has 5,040,000 patches");
});

test("a vertex of thousands of faces is refused, and of hundreds not", () => {
  const wheel = (faces: number): PolygonMesh => {
    const mesh = torus(3, 3);
    const positions = Float64Array.from({ length: 3 * (faces + 1) }, (_, i) => Math.cos(i));
    const corners = Int32Array.from({ length: 3 * faces }, (_, i) =>
      i % 3 === 0 ? faces : (Math.floor(i / 3) + (i % 3) - 1) % faces,
    );
    const starts = Int32Array.from({ length: faces + 1 }, (_, f) => 3 * f);
    return {
      ...mesh,
      positions,
      corners,
      starts,
      creaseEdges: new Int32Array(0),
      creaseSharpness: new Float32Array(0),
    };
  };
  expect(() => new Slates(wheel(30_000))).toThrow("has 30000 faces at vertex 30000");
  const surface = new Slates(wheel(300));
  surface.show([1]);
  expect(surface.shown.triangles).toBe(900 * 8);
});
