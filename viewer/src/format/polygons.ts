/** Polygons with creases in chunk 0 of a `.fov` of kind `cage`, version 2 (spec/container.md). */
import { damaged, type Header } from "./container";

export const BOUNDARIES = ["edge_only", "edge_and_corner", "none"] as const;

/** A mesh of polygons over shared vertices, whose lengths fit together and whose indices exist. */
export interface PolygonMesh {
  /** Three doubles a vertex, finite. */
  readonly positions: Float64Array;
  /** `corners[starts[f]]` to `corners[starts[f + 1] - 1]` are the vertices of face f, counter-clockwise. */
  readonly starts: Int32Array;
  readonly corners: Int32Array;
  /** Two vertices each. */
  readonly creaseEdges: Int32Array;
  /** 0 is smooth, 10 or more sharp for ever. */
  readonly creaseSharpness: Float32Array;
  readonly cornerVertices: Int32Array;
  readonly cornerSharpness: Float32Array;
  readonly boundary: (typeof BOUNDARIES)[number];
  /** sRGB, 0 to 255: three a vertex. */
  readonly colours?: Float32Array | undefined;
  /** Two a vertex. */
  readonly uvs?: Float32Array | undefined;
  /** Faces that are left out of the surface, though they bend the others; rising. */
  readonly holes?: Int32Array | undefined;
}

/** What a header says of the chunk's columns. */
interface Counts {
  readonly vertices: number;
  readonly faces: number;
  readonly corners: number;
  readonly creases: number;
  readonly sharpCorners: number;
  readonly boundary: (typeof BOUNDARIES)[number];
  readonly hasColours: boolean;
  readonly hasUvs: boolean;
  readonly holes: number;
}

/** Of vertices, faces, corners, .., these in all places. */
export const MOST = 2 ** 26;

/** @throws Problem if header and chunk do not hold together. That it is a surface is not yet checked. */
export function polygonsOf(chunk: Uint8Array, header: Header, name: string): PolygonMesh {
  const counts = countsOf(header);
  const mesh = counts && columnsOf(chunk, counts);
  if (!mesh) throw damaged(name);
  return mesh;
}

function countsOf(header: Header): Counts | null {
  const { vertices, faces, corners, creases, sharp_corners: sharpCorners, attributes, holes = 0 } = header;
  const boundary = BOUNDARIES.find((known) => known === header.boundary);
  const areCounts = [vertices, faces, corners].every((n) => isCount(n, 1));
  if (!areCounts || !isCount(creases, 0) || !isCount(sharpCorners, 0) || !boundary) return null;
  if (!isCount(holes, header.holes === undefined ? 0 : 1)) return null;
  if (header.triangles !== (corners as number) - 2 * (faces as number)) return null;
  const names = JSON.stringify(attributes ?? null);
  if (!["[]", '["colour"]', '["uv"]', '["colour","uv"]'].includes(names)) return null;
  const [hasColours, hasUvs] = [names.includes("colour"), names.includes("uv")];
  const numbers = { vertices, faces, corners, creases, sharpCorners, holes } as Record<string, number>;
  return { ...numbers, boundary, hasColours, hasUvs } as unknown as Counts;
}

function columnsOf(chunk: Uint8Array, counts: Counts): PolygonMesh | null {
  const { vertices: n, faces, corners: k, creases, sharpCorners, boundary, hasColours, hasUvs } = counts;
  const wide = (hasColours ? 3 : 0) + (hasUvs ? 2 : 0);
  const words = faces + k + 3 * creases + 2 * sharpCorners + wide * n + counts.holes;
  if (chunk.length !== 24 * n + 4 * words) return null;
  const { buffer } = chunk.slice();
  let at = 24 * n;
  const take = <T>(Column: new (buffer: ArrayBuffer, at: number, length: number) => T, length: number): T => {
    at += 4 * length;
    return new Column(buffer, at - 4 * length, length);
  };
  const starts = startsOf(take(Uint32Array, faces), k);
  const mesh = {
    positions: new Float64Array(buffer, 0, 3 * n),
    corners: take(Int32Array, k),
    creaseEdges: take(Int32Array, 2 * creases),
    creaseSharpness: take(Float32Array, creases),
    cornerVertices: take(Int32Array, sharpCorners),
    cornerSharpness: take(Float32Array, sharpCorners),
    boundary,
    colours: hasColours ? take(Float32Array, 3 * n) : undefined,
    uvs: hasUvs ? take(Float32Array, 2 * n) : undefined,
    holes: take(Int32Array, counts.holes),
  };
  const isSound = starts !== null && areFinite(mesh.positions) && areVertices(mesh, n) && areTags(mesh);
  const isDrawn = areFinite(mesh.uvs ?? []) && (mesh.colours ?? []).every((c) => c >= 0 && c <= 255);
  return isSound && isDrawn && areHoles(mesh.holes, faces) ? { ...mesh, starts } : null;
}

/** Null if a face has fewer than three corners, or they are not as many together as there should be. */
function startsOf(sizes: Uint32Array, corners: number): Int32Array | null {
  const starts = new Int32Array(sizes.length + 1);
  let total = 0;
  for (let f = 0; f < sizes.length; f++) {
    total += sizes[f]!;
    if (sizes[f]! < 3 || total > corners) return null;
    starts[f + 1] = total;
  }
  return total === corners ? starts : null;
}

type Columns = Pick<
  PolygonMesh,
  "corners" | "creaseEdges" | "cornerVertices" | "creaseSharpness" | "cornerSharpness"
>;

function areVertices({ corners, creaseEdges, cornerVertices }: Columns, count: number): boolean {
  const isVertex = (v: number) => v >= 0 && v < count;
  return corners.every(isVertex) && creaseEdges.every(isVertex) && cornerVertices.every(isVertex);
}

function areTags({ creaseSharpness, cornerSharpness }: Columns): boolean {
  const isSharpness = (s: number) => s >= 0; // so that it is a number
  return creaseSharpness.every(isSharpness) && cornerSharpness.every(isSharpness);
}

/** Rising, each once, and not all. */
function areHoles(holes: Int32Array, faces: number): boolean {
  const isRising = holes.every((f, i) => f > (i > 0 ? holes[i - 1]! : -1));
  return isRising && holes.length < faces && (holes.at(-1) ?? 0) < faces;
}

function areFinite(values: Float64Array | Float32Array | readonly number[]): boolean {
  for (const value of values) if (!Number.isFinite(value)) return false;
  return true;
}

function isCount(value: unknown, least: number): value is number {
  return Number.isInteger(value) && (value as number) >= least && (value as number) <= MOST;
}
