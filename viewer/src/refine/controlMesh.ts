/** The control mesh in chunk 0 of a `.fov` of kind `cage` (spec/container.md). */
import type { CageInfo } from "../format/cage";
import { damaged } from "../format/container";
import { crc32 } from "../format/crc32";
import { type PolygonMesh, polygonsOf } from "../format/polygons";
import { firstChunk, type OpenFile } from "../stream/file";
import type { ControlMesh } from "./surface";

const VERTEX_BYTES = 24;
const FACE_BYTES = 12;

/** @throws Problem if it cannot be fetched, or is not what the header says. */
export async function readControlMesh(file: OpenFile, info: CageInfo): Promise<ControlMesh> {
  const mesh = controlMeshOf(await checkedChunk(file), info);
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
  return polygonsOf(await checkedChunk(file), file.container.header, name);
}

async function checkedChunk(file: OpenFile): Promise<Uint8Array> {
  const chunk = await firstChunk(file);
  if (crc32(chunk) !== file.container.checksums[0]) throw damaged(file.source.name);
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
