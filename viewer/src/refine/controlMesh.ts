/** What the chunks of a `.fov` of kind `cage` hold: the control mesh, and where it stands (spec/container.md). */
import type { CageInfo } from "../format/cage";
import { damaged } from "../format/container";
import { crc32 } from "../format/crc32";
import { placementsOf } from "../format/placements";
import { MOST, type PolygonMesh, polygonsOf } from "../format/polygons";
import { chunkOf, type OpenFile } from "../stream/file";
import type { ControlMesh } from "./surface";

const VERTEX_BYTES = 24;
const FACE_BYTES = 12;

/** @throws Problem if it cannot be fetched, or is not what the header says. */
export async function readControlMesh(file: OpenFile, info: CageInfo): Promise<ControlMesh> {
  const mesh = controlMeshOf(await checkedChunk(file, 0), info);
  if (!mesh) throw damaged(file.source.name);
  return mesh;
}

/**
 * What Catmull-Clark patches are made of: polygons, or the triangles as such.
 *
 * @throws Problem as `readControlMesh`.
 */
export async function readPolygons(file: OpenFile, info: CageInfo): Promise<PolygonMesh> {
  const { name } = file.source;
  if (info.polygons === undefined) return polygonsOfTriangles(await readControlMesh(file, info));
  return polygonsOf(await checkedChunk(file, 0), file.container.header, name);
}

/**
 * Where polygons stand, by 16 numbers each; undefined where they stand once, where they are.
 *
 * @throws Problem as `readControlMesh`.
 */
export async function readPlacements(
  file: OpenFile,
  { placements }: CageInfo,
): Promise<Float64Array | undefined> {
  const { container, source } = file;
  if (container.lengths.length !== (placements === undefined ? 1 : 2)) throw damaged(source.name);
  if (placements === undefined) return undefined;
  const isWithin = placements * (container.header.corners as number) <= MOST;
  const matrices = isWithin && placementsOf(await checkedChunk(file, 1), placements);
  if (!matrices) throw damaged(source.name);
  return matrices;
}

async function checkedChunk(file: OpenFile, number: number): Promise<Uint8Array> {
  const chunk = await chunkOf(file, number);
  if (crc32(chunk) !== file.container.checksums[number]) throw damaged(file.source.name);
  return chunk;
}

function polygonsOfTriangles({ positions, faces }: ControlMesh): PolygonMesh {
  return {
    positions,
    starts: Int32Array.from({ length: faces.length / 3 + 1 }, (_, f) => 3 * f),
    corners: faces,
    creaseEdges: new Int32Array(0),
    creaseSharpness: new Float32Array(0),
    cornerVertices: new Int32Array(0),
    cornerSharpness: new Float32Array(0),
    boundary: "edge_only",
  };
}

/** Positions as doubles, then faces; null where they do not hold together. */
export function controlMeshOf(
  chunk: Uint8Array,
  { vertices, triangles, sharpEdges }: CageInfo,
): ControlMesh | null {
  if (chunk.length !== VERTEX_BYTES * vertices + FACE_BYTES * triangles) return null;
  const { buffer } = chunk.slice();
  const positions = new Float64Array(buffer, 0, 3 * vertices);
  const faces = new Int32Array(buffer, VERTEX_BYTES * vertices);
  const isSound = positions.every(Number.isFinite) && faces.every((v) => v >= 0 && v < vertices);
  return isSound ? { positions, faces, sharp: Int32Array.from(sharpEdges) } : null;
}
