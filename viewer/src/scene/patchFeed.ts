/** Between the streamer and the layers of patches: what arrived goes to them, what they miss is asked for. */
import type { Asset } from "../stream/asset";
import type { NodeAt, Streamer } from "../stream/streamer";
import type { Frame } from "./frame";
import type { PatchMaterials } from "./material";
import { PatchLayer } from "./patchLayer";

/** What may be handed to the GPU in one frame: about 2 ms of copying on a slow machine. */
const UPLOAD_BYTES = 2 << 20;
const UPLOAD_MS = 4;
/** The share of the memory budget that a cut may ask for; the rest holds what fades out, and the way back. */
const CUT_SHARE = 0.8;

export class PatchFeed {
  readonly #layers: PatchLayer[] = [];
  #hasMore = false;

  constructor(private readonly streamer: Streamer) {}

  /** There is more to hand over than one frame takes. */
  get hasMore(): boolean {
    return this.#hasMore;
  }

  get isSettled(): boolean {
    return this.streamer.isSettled;
  }

  /** GPU memory for what is chosen. */
  get cutBytes(): number {
    return CUT_SHARE * this.streamer.budgetBytes;
  }

  /** A layer of this asset's patches. */
  open(name: string, asset: Asset, frame: Frame, materials: PatchMaterials): PatchLayer {
    const layer = new PatchLayer(name, asset, this.streamer.add(asset), frame, materials, this);
    this.#layers.push(layer);
    return layer;
  }

  /** Keep this node: the present picture draws it. */
  touch(at: NodeAt): void {
    this.streamer.touch(at);
  }

  /** Before the layers choose: hand over what arrived, a slice a frame. */
  begin(): void {
    this.streamer.beginFrame();
    const begin = performance.now();
    let bytes = 0;
    this.#hasMore = false;
    while (bytes < UPLOAD_BYTES && performance.now() - begin < UPLOAD_MS) {
      const ready = this.streamer.take();
      if (!ready) return;
      bytes += ready.bytes;
      this.#layers[ready.asset]?.addNode(ready.node, ready.patches);
    }
    this.#hasMore = true;
  }

  /** After the layers chose: ask for what visible ones miss, and drop what no picture needs. */
  finish(): void {
    const visible = this.#layers.filter((layer) => layer.group.visible);
    const wanted = visible.flatMap((layer) => layer.wanted());
    if (visible.length > 1) wanted.sort((a, b) => b.errorPx - a.errorPx);
    this.streamer.want(wanted);
    for (const { asset, node } of this.streamer.evict()) this.#layers[asset]?.removeNode(node);
  }

  /** The GPU is gone, and what was on it. */
  forgetAll(): void {
    this.streamer.forgetAll();
  }
}
