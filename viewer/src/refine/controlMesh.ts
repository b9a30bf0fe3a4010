/** The control mesh in chunk 0 of a `.fov` of kind `cage` (spec/container.md). */
import type { CageInfo } from "../format/cage";
import { damaged } from "../format/container";
import { crc32 } from "../format/crc32";
import { firstChunk, type OpenFile } from "../stream/file";
import type { ControlMesh } from "./surface";

const VERTEX_BYTES = 24;
const FACE_BYTES = 12;

/** @throws Problem if it cannot be fetched, or is not what the header says. */
export async function readControlMesh(file: OpenFile, info: CageInfo): Promise<ControlMesh> {
  const { name } = file.source;
  const chunk = await firstChunk(file);
  if (crc32(chunk) !== file.container.checksums[0]) throw damaged(name);
  const mesh = controlMeshOf(chunk, info);
  if (!mesh) throw damaged(name);
  return mesh;
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
