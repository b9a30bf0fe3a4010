/** Brings nodes from files to memory: queue, workers and cache behind one door. */
import { Problem, sentenceOf } from "../format/problem";
import type { Asset } from "./asset";
import { ByteCache } from "./cache";
import type { PackedPatch } from "./pack";
import { ChecksumError, type DecoderPool } from "./pool";
import { RequestQueue, type Want } from "./queue";
import { Passing } from "./source";

/** A node of one of the assets. */
export interface NodeAt {
  readonly asset: number;
  readonly node: number;
}

/** A decoded node that waits to be taken to the GPU. */
export interface ReadyNode extends NodeAt {
  readonly patches: readonly PackedPatch[];
  readonly bytes: number;
}

export interface StreamerOptions {
  readonly pool: DecoderPool;
  readonly budgetBytes: number;
  /** Something arrived or failed: a new frame may look different. */
  readonly onChange: () => void;
  /** A sentence for the visitor, and the node that cannot be had. */
  readonly onProblem: (problem: Problem, at: NodeAt) => void;
}

export class Streamer {
  readonly #assets: { asset: Asset; base: number }[] = [];
  readonly #queue: RequestQueue;
  readonly #cache = new ByteCache();
  /** Nodes being decoded, and decoded ones in the order they came. */
  readonly #decoding = new Set<number>();
  #ready: (ReadyNode & { key: number })[] = [];
  readonly #failed = new Map<number, number>();
  readonly #wanted = new Set<number>();
  #nextBase = 0;
  #epoch = 0;
  #frame = 0;
  budgetBytes: number;

  constructor(private readonly options: StreamerOptions) {
    this.budgetBytes = options.budgetBytes;
    this.#queue = new RequestQueue({
      read: (asset, start, end, signal, isFresh) =>
        this.#assets[asset]!.asset.source.read(start, end, signal, isFresh),
      deliver: (want, bytes) => void this.#decode(want, bytes as Uint8Array<ArrayBuffer>),
      fail: (want, error) => this.#fail(want.key, want.asset, error),
    });
  }

  /** Take in an asset; its number. */
  add(asset: Asset): number {
    const index = this.#assets.length;
    this.#assets.push({ asset, base: this.#nextBase });
    this.#nextBase += asset.graph.nodes;
    this.options.pool.open(index, asset.tables, asset.info.streams);
    return index;
  }

  /** Bytes of nodes on the GPU or waiting for it. */
  get cachedBytes(): number {
    return this.#cache.bytes + this.#comingBytes();
  }

  get cachedNodes(): number {
    return this.#cache.size;
  }

  get receivedBytes(): number {
    return this.#assets.reduce((sum, { asset }) => sum + asset.source.received, 0);
  }

  get inFlight(): number {
    return this.#queue.inFlight;
  }

  /** Nothing that was wanted is missing, but for what could not be had at all. */
  get isSettled(): boolean {
    return (
      this.#wanted.size === 0 && this.#decoding.size === 0 && this.#ready.length === 0 && this.inFlight === 0
    );
  }

  /** Begin a frame: what is not touched in it may be let go. */
  beginFrame(): void {
    this.#frame++;
  }

  /** Keep this node: the present frame draws it. */
  touch(at: NodeAt): void {
    this.#cache.touch(this.#keyOf(at), this.#frame);
  }

  /** Replace what is wanted, most urgent first. */
  want(nodes: readonly NodeAt[]): void {
    this.#wanted.clear();
    const wants: Want[] = [];
    for (const at of nodes) {
      const key = this.#keyOf(at);
      if (this.#failed.get(key) === Infinity) continue;
      this.#wanted.add(key);
      if (this.#decoding.has(key) || this.#ready.some((ready) => ready.key === key)) continue;
      const { starts, lengths } = this.#assets[at.asset]!.asset.container;
      const start = starts[at.node + 1]!;
      wants.push({ key, asset: at.asset, start, end: start + lengths[at.node + 1]! });
    }
    this.#queue.want(wants);
  }

  /** The next decoded node for the GPU, if there is one; it counts as resident from now on. */
  take(): ReadyNode | undefined {
    const next = this.#ready.shift();
    if (!next) return undefined;
    const error = this.#assets[next.asset]!.asset.graph.errors[next.node]!;
    this.#cache.add(next.key, next.bytes, error, this.#frame);
    this.#wanted.delete(next.key);
    return next;
  }

  /** Nodes to drop from the GPU, so that all and what is coming fits the budget. */
  evict(): NodeAt[] {
    const keys = this.#cache.evict(this.budgetBytes, this.#comingBytes(), this.#frame);
    return keys.map((key) => this.#nodeOf(key));
  }

  /** Forget all that was on the GPU, when it was lost. Answers under way are dropped when they come. */
  forgetAll(): void {
    this.#epoch++;
    this.#cache.clear();
    this.#ready = [];
    this.#decoding.clear();
    this.#wanted.clear();
    this.#queue.want([]);
  }

  /** Try again what failed, e.g. when the network is back. */
  retry(): void {
    this.#failed.clear();
    this.#queue.forgive();
    this.options.onChange();
  }

  #keyOf(at: NodeAt): number {
    return this.#assets[at.asset]!.base + at.node;
  }

  #nodeOf(key: number): NodeAt {
    let asset = this.#assets.length - 1;
    while (this.#assets[asset]!.base > key) asset--;
    return { asset, node: key - this.#assets[asset]!.base };
  }

  #comingBytes(): number {
    let sum = 0;
    for (const ready of this.#ready) sum += ready.bytes;
    for (const key of this.#decoding) {
      const { asset, node } = this.#nodeOf(key);
      sum += this.#assets[asset]!.asset.nodeBytes[node]!;
    }
    return sum;
  }

  async #decode(want: Want, bytes: Uint8Array<ArrayBuffer>): Promise<void> {
    const { key, asset } = want;
    const { node } = this.#nodeOf(key);
    const { graph, container, nodeBytes } = this.#assets[asset]!.asset;
    const patchBytes = graph.patchBytes.slice(graph.firstPatch[node], graph.firstPatch[node + 1]);
    const epoch = this.#epoch;
    this.#decoding.add(key);
    try {
      const checksum = container.checksums[node + 1]!;
      const patches = await this.options.pool.decode({ asset, bytes, patchBytes, checksum });
      if (epoch !== this.#epoch) return;
      this.#decoding.delete(key);
      this.#ready.push({ key, asset, node, patches, bytes: nodeBytes[node]! });
      this.options.onChange();
    } catch (error) {
      if (epoch !== this.#epoch) return;
      this.#decoding.delete(key);
      this.#fail(key, asset, error);
    }
  }

  /** A wrong checksum is fetched once more past all caches; what fails for good is not asked for again. */
  #fail(key: number, asset: number, error: unknown): void {
    const isFirstChecksum = error instanceof ChecksumError && !this.#failed.has(key);
    if (isFirstChecksum) {
      this.#failed.set(key, 1);
      this.#queue.refresh(key);
    } else {
      this.#failed.set(key, Infinity);
      this.#wanted.delete(key);
      const { name } = this.#assets[asset]!.asset.source;
      const problem = error instanceof Problem ? error : this.#describe(error, name);
      this.options.onProblem(problem, this.#nodeOf(key));
    }
    this.options.onChange();
  }

  #describe(error: unknown, name: string): Problem {
    if (error instanceof Passing) return new Problem("network", error.message);
    const why = error instanceof ChecksumError ? "a checksum does not agree." : sentenceOf(error);
    return new Problem("damaged", `A part of ${name} cannot be shown: ${why}`);
  }
}
