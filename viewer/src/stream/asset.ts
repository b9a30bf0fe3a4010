/** An opened `.fov` of patches: what is known of it before any patch is loaded. */
import { damaged } from "../format/container";
import { crc32 } from "../format/crc32";
import { type Graph, type MultiresInfo, parseGraph, parseInfo } from "../format/graph";
import { chunkOf, type OpenFile, type OpenOptions, openFile } from "./file";

export interface Asset extends OpenFile {
  readonly info: MultiresInfo;
  readonly graph: Graph;
  /** The codec's shared tables. */
  readonly tables: Uint8Array;
  /** Bytes of GPU memory each node takes, known before it is loaded. */
  readonly nodeBytes: Float64Array;
}

/**
 * Fetch and check header, index and graph.
 *
 * @throws Problem in a sentence about the file.
 */
export async function openAsset(url: string, options: OpenOptions = {}): Promise<Asset> {
  return assetOf(await openFile(url, options), options.signal);
}

/**
 * The asset of a file whose header and index are here already.
 *
 * @throws Problem in a sentence about the file.
 */
export async function assetOf(file: OpenFile, signal?: AbortSignal): Promise<Asset> {
  const { source, container } = file;
  const { name } = source;
  const info = parseInfo(container.header, name);
  const chunk = await chunkOf(file, 0, signal);
  if (crc32(chunk) !== container.checksums[0]) throw damaged(name);
  const { graph, tables } = parseGraph(chunk, container, name);
  return { source, container, info, graph, tables, nodeBytes: bytesOfNodes(graph, info) };
}

/** As `packPatch` will lay them out: 8 bytes a position, 4 a normal, 4 a colour, 6 or 12 a triangle. */
function bytesOfNodes(graph: Graph, info: MultiresInfo): Float64Array {
  const has = (name: string): number => (info.streams.some((stream) => stream.name === name) ? 4 : 0);
  const perVertex = 8 + has("normal") + has("colour");
  const out = new Float64Array(graph.nodes);
  for (let node = 0; node < graph.nodes; node++) {
    for (let p = graph.firstPatch[node]!; p < graph.firstPatch[node + 1]!; p++) {
      const vertices = graph.vertices[p]!;
      out[node]! += perVertex * vertices + (vertices > 65536 ? 12 : 6) * graph.triangles[p]!;
    }
  }
  return out;
}
