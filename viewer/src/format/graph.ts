/** Header and chunk 0 of kind `multires`: what is known of every patch before any is loaded. */
import { type Container, damaged, type Header } from "./container";
import type { PatchStream } from "./patch";
import { Problem } from "./problem";

const KIND = "multires";
const VERSION = 1;
const MAX_PATCH_TRIANGLES = 1 << 21;
const MAX_PATCH_VERTICES = 1 << 20;

export type Triple = readonly [number, number, number];
export type Axis = "x" | "y" | "z";

/** The graph of patches; see `src/foveal/lod/graph.py` for its laws. Lengths in the asset's unit. */
export interface Graph {
  readonly nodes: number;
  readonly patches: number;
  /** Node i holds patches firstPatch[i] to firstPatch[i + 1] - 1. */
  readonly firstPatch: Uint32Array;
  /** x, y, z, radius a node, relative to the asset's origin. */
  readonly spheres: Float32Array;
  /** Infinite for node 0. */
  readonly errors: Float32Array;
  /** Node that refines the patch, -1 for none. */
  readonly finer: Int32Array;
  readonly triangles: Uint32Array;
  readonly vertices: Uint32Array;
  readonly patchBytes: Uint32Array;
}

/** What a `.fov` of kind multires says of itself. */
export interface MultiresInfo {
  readonly origin: Triple;
  readonly step: number;
  /** Least and greatest grid position. */
  readonly box: readonly [Triple, Triple];
  readonly up: Axis;
  readonly unit: string | null;
  readonly triangles: number;
  readonly streams: readonly PatchStream[];
}

/** @throws Problem if the kind or its version is not known, or a value that is needed makes no sense. */
export function parseInfo(header: Header, name: string): MultiresInfo {
  if (header.kind !== KIND) {
    throw new Problem(
      "version",
      `${name} is of kind "${String(header.kind)}"; this viewer shows "${KIND}". Update foveal.`,
    );
  }
  if (header.version !== VERSION) {
    throw new Problem(
      "version",
      `${name} has version ${String(header.version)} of kind "${KIND}"; this viewer knows version ${VERSION}. Update foveal, or build the file again.`,
    );
  }
  const { step, up, unit, triangles } = header;
  const box = header.box;
  if (typeof step !== "number" || !(step > 0) || !Number.isFinite(step)) throw damaged(name);
  if (!Array.isArray(box) || box.length !== 2) throw damaged(name);
  return {
    origin: triple(header.origin, name),
    step,
    box: [triple(box[0], name), triple(box[1], name)],
    up: up === "x" || up === "z" ? up : "y",
    unit: typeof unit === "string" ? unit : null,
    triangles: typeof triangles === "number" ? triangles : 0,
    streams: streamsOf(header.streams, name),
  };
}

function triple(value: unknown, name: string): Triple {
  const isTriple = Array.isArray(value) && value.length === 3 && value.every((x) => Number.isFinite(x));
  if (!isTriple) throw damaged(name);
  return value as unknown as Triple;
}

function streamsOf(value: unknown, name: string): PatchStream[] {
  if (!Array.isArray(value)) throw damaged(name);
  return value.map((stream: Partial<PatchStream> | null) => {
    if (typeof stream?.name !== "string" || typeof stream.type !== "string") throw damaged(name);
    return stream as PatchStream;
  });
}

/**
 * Chunk 0 as columns, and the codec's tables after them.
 *
 * @throws Problem if the columns break a law that the viewer leans on.
 */
export function parseGraph(
  chunk: Uint8Array,
  container: Container,
  name: string,
): { graph: Graph; tables: Uint8Array } {
  const nodes = count(container.header.nodes, name);
  const patches = count(container.header.patches, name);
  const bytes = 4 * (nodes + 1) + 20 * nodes + 16 * patches;
  if (nodes + 1 !== container.lengths.length || bytes > chunk.length) throw damaged(name);
  const own = chunk.slice(0, bytes).buffer; // aligned, and free of the bytes around it
  let at = 0;
  const column = <T>(Type: new (b: ArrayBuffer, o: number, n: number) => T, n: number): T => {
    at += 4 * n;
    return new Type(own, at - 4 * n, n);
  };
  const graph: Graph = {
    nodes,
    patches,
    firstPatch: column(Uint32Array, nodes + 1),
    spheres: column(Float32Array, 4 * nodes),
    errors: column(Float32Array, nodes),
    finer: column(Int32Array, patches),
    triangles: column(Uint32Array, patches),
    vertices: column(Uint32Array, patches),
    patchBytes: column(Uint32Array, patches),
  };
  if (!isSound(graph, container)) throw damaged(name);
  return { graph, tables: chunk.slice(bytes) };
}

function count(value: unknown, name: string): number {
  if (typeof value !== "number" || !Number.isInteger(value) || value < 1 || value > 1 << 26)
    throw damaged(name);
  return value;
}

function isSound(graph: Graph, container: Container): boolean {
  const { nodes, patches, firstPatch, spheres, errors, finer, triangles, vertices, patchBytes } = graph;
  if (firstPatch[0] !== 0 || firstPatch[nodes] !== patches) return false;
  for (let node = 0; node < nodes; node++) {
    const begin = firstPatch[node]!;
    const end = firstPatch[node + 1]!;
    if (end < begin || end > patches) return false;
    let sum = 0;
    for (let p = begin; p < end; p++) {
      const next = finer[p]!;
      if (next !== -1 && (next <= node || next >= nodes)) return false;
      if (triangles[p]! > MAX_PATCH_TRIANGLES || vertices[p]! > MAX_PATCH_VERTICES) return false;
      sum += patchBytes[p]!;
    }
    if (sum !== container.lengths[node + 1]) return false;
    if (!(errors[node]! >= 0) || (node > 0 && errors[node] === Infinity)) return false;
  }
  return spheres.every((value) => Number.isFinite(value));
}

/** For each node the nodes that hold a patch which it refines, as one list with offsets. */
export function parentsOf(graph: Graph): { first: Uint32Array; parents: Uint32Array } {
  const pairs = new Set<number>();
  for (let node = 0; node < graph.nodes; node++) {
    for (let p = graph.firstPatch[node]!; p < graph.firstPatch[node + 1]!; p++) {
      const next = graph.finer[p]!;
      if (next >= 0) pairs.add(next * graph.nodes + node);
    }
  }
  const sorted = Float64Array.from(pairs).sort();
  const first = new Uint32Array(graph.nodes + 1);
  const parents = new Uint32Array(sorted.length);
  sorted.forEach((pair, i) => {
    const child = Math.floor(pair / graph.nodes);
    first[child + 1] = i + 1;
    parents[i] = pair - child * graph.nodes;
  });
  for (let node = 1; node <= graph.nodes; node++) first[node] = Math.max(first[node]!, first[node - 1]!);
  return { first, parents };
}
