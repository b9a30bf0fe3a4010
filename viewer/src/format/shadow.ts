/** Kind `shadow`: a light, how it sees, and its trees, which come level by level (spec/container.md). */
import { damaged, type Header } from "./container";
import { Problem } from "./problem";
import { TreeReader } from "./shadowDecode";
import { type Counts, isPossible, MOST_LEVELS, type Tree } from "./shadowTree";

export const SHADOW = "shadow";
const VERSION = 1;

/** What a `.fov` of kind `shadow` says of itself. */
export interface ShadowInfo {
  /** As it was asked for: kind, direction, time. */
  readonly light: Header;
  /** 4 × 4 matrices, row by row, from the world to the map's square and depth: one a tree, or one an image. */
  readonly projections: readonly Float64Array[];
  /** 2^levels pixels a side. */
  readonly levels: number;
  /** 4, or 8 of a stack of images. */
  readonly children: 4 | 8;
  /** Of a stack; else 1. */
  readonly images: number;
  /** Of a stack: image i is at place i 2^spread of the octree's third axis. */
  readonly spread: number;
  /** Levels with which chunks end; a map of 2^parts[p] pixels a side is there after 1 + (p + 1) · trees chunks. */
  readonly parts: readonly number[];
  readonly trees: number;
}

/** @throws Problem if the version is not known, or a value that is needed makes no sense. */
export function parseShadow(header: Header, name: string): ShadowInfo {
  if (header.version !== VERSION) {
    throw new Problem(
      "version",
      `${name} has version ${String(header.version)} of kind "${SHADOW}"; this viewer knows version ${VERSION}. Update foveal, or build the file again.`,
    );
  }
  const { light, levels, children, parts } = header;
  if (typeof light !== "object" || light === null || Array.isArray(light)) throw damaged(name);
  if (!isLevel(levels) || (children !== 4 && children !== 8)) throw damaged(name);
  if (!Array.isArray(header.projections) || header.projections.length === 0) throw damaged(name);
  const projections = header.projections.map((rows) => matrixOf(rows, name));
  if (!areParts(parts, levels)) throw damaged(name);
  const isStack = children === 8;
  const spread = (isStack && header.spread) || 0;
  if (!isLevel(spread) || (isStack && (projections.length - 1) * 2 ** spread >= 2 ** levels))
    throw damaged(name);
  return {
    light: light as Header,
    projections,
    levels,
    children,
    images: isStack ? projections.length : 1,
    spread,
    parts,
    trees: isStack ? 1 : projections.length,
  };
}

/**
 * Reads the trees of a file: give it chunk 0, then the others in their order, as they come. It holds no more than they
 * say, and needs nothing of the page, so that a worker may have it.
 */
export class ShadowReader {
  private readonly readers: TreeReader[];
  private pushed = 0;

  /** @throws Problem if chunk 0, of counts, is damaged. */
  constructor(
    private readonly info: ShadowInfo,
    counts: Uint8Array,
    private readonly name: string,
  ) {
    this.readers = countsOf(info, counts, name).map((one) => new TreeReader(one, info.parts));
  }

  /** Chunks of the file, after which all is there. */
  get chunks(): number {
    return 1 + this.info.parts.length * this.info.trees;
  }

  /** Levels of the map that can be looked up so far; -1 if none can. */
  get levels(): number {
    return this.info.parts[Math.floor(this.pushed / this.info.trees) - 1] ?? -1;
  }

  /**
   * Read chunk 1, 2, ...; true if a finer map is whole with it, which `trees` gives.
   *
   * @throws Problem if it is damaged, or one too many.
   */
  push(chunk: Uint8Array): boolean {
    const reader = this.readers[this.pushed % this.info.trees]!;
    if (this.pushed + 1 >= this.chunks || !reader.push(chunk)) throw damaged(this.name);
    this.pushed++;
    return this.pushed % this.info.trees === 0;
  }

  /** One tree a projection, or one of a stack, of `levels`; right after `push` said that they are whole. */
  trees(): Tree[] {
    return this.readers.map((reader) => reader.tree());
  }
}

function countsOf(info: ShadowInfo, chunk: Uint8Array, name: string): Counts[] {
  const { levels, children, trees } = info;
  const size = 8 * (levels + 1);
  if (chunk.length !== trees * size) throw damaged(name);
  const view = new DataView(chunk.buffer, chunk.byteOffset, chunk.byteLength);
  return Array.from({ length: trees }, (_, tree) => {
    const words = Array.from({ length: 2 * levels + 2 }, (_, i) => view.getUint32(tree * size + 4 * i, true));
    const [root = 0, ...numbers] = words;
    const counts = { levels, children, root, masks: numbers.slice(0, levels), values: numbers.slice(levels) };
    if (!isPossible(counts)) throw damaged(name);
    return counts;
  });
}

function matrixOf(rows: unknown, name: string): Float64Array {
  if (!Array.isArray(rows) || rows.length !== 4) throw damaged(name);
  const numbers = rows.flatMap((row) => (Array.isArray(row) && row.length === 4 ? row : []));
  if (numbers.length !== 16 || !numbers.every(Number.isFinite)) throw damaged(name);
  return Float64Array.from(numbers);
}

function isLevel(value: unknown): value is number {
  return Number.isInteger(value) && (value as number) >= 0 && (value as number) <= MOST_LEVELS;
}

function areParts(value: unknown, levels: number): value is number[] {
  if (!Array.isArray(value) || value.length === 0 || !value.every(isLevel)) return false;
  return value[value.length - 1] === levels && value.every((part, i) => i === 0 || value[i - 1]! < part);
}
