/** An opened `.fov`: what is known of it before any patch is loaded. */
import { type Container, damaged, headLength, parseContainer } from "../format/container";
import { crc32 } from "../format/crc32";
import { type Graph, type MultiresInfo, parseGraph, parseInfo } from "../format/graph";
import { type Fetch, Passing, Source } from "./source";

export interface Asset {
  readonly source: Source;
  readonly container: Container;
  readonly info: MultiresInfo;
  readonly graph: Graph;
  /** The codec's shared tables. */
  readonly tables: Uint8Array;
  /** Bytes of GPU memory each node takes, known before it is loaded. */
  readonly nodeBytes: Float64Array;
}

const TRIES = 4;

/**
 * Fetch and check header, index and graph.
 *
 * @throws Problem in a sentence about the file.
 */
export async function openAsset(
  url: string,
  options: { signal?: AbortSignal; onProgress?: (share: number) => void; fetch?: Fetch } = {},
): Promise<Asset> {
  const source = await persist(() => Source.open(url, options.signal, options.onProgress, options.fetch));
  const { name } = source;
  const headBytes = await atLeast(source, headLength(source.head, name), options.signal);
  const container = parseContainer(headBytes, name, source.size);
  const info = parseInfo(container.header, name);
  const first = container.starts[0]!;
  const firstEnd = first + container.lengths[0]!;
  const bytes = await atLeast(source, firstEnd, options.signal);
  const chunk = bytes.subarray(first, firstEnd);
  if (crc32(chunk) !== container.checksums[0]) throw damaged(name);
  const { graph, tables } = parseGraph(chunk, container, name);
  return { source, container, info, graph, tables, nodeBytes: bytesOfNodes(graph, info) };
}

/** The file's first bytes up to `end`, the missing ones fetched. */
async function atLeast(source: Source, end: number, signal?: AbortSignal): Promise<Uint8Array> {
  const have = source.head;
  if (end <= have.length) return have;
  if (source.size !== null && end > source.size) throw damaged(source.name);
  const rest = await persist(() => source.read(have.length, end, signal));
  const all = new Uint8Array(end);
  all.set(have);
  all.set(rest, have.length);
  source.head = all;
  return all;
}

/** Try again, ever later, what may pass. */
export async function persist<T>(work: () => Promise<T>, tries = TRIES, firstPause = 300): Promise<T> {
  for (let attempt = 1; ; attempt++) {
    try {
      return await work();
    } catch (error) {
      if (!(error instanceof Passing) || attempt >= tries) throw error;
      await new Promise((resolve) => setTimeout(resolve, firstPause * 2 ** (attempt - 1)));
    }
  }
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
