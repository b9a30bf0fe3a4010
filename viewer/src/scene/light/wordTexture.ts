/** The words of a shadow map on the GPU, brought there a slice a frame; the map before stays until all are there. */
import {
  Box2,
  DataTexture,
  NearestFilter,
  RedIntegerFormat,
  UnsignedIntType,
  Vector2,
  type WebGLRenderer,
} from "three";
import { Problem } from "../../format/problem";
import type { ShadowStage } from "../../stream/shadowStage";

/** Copied at once: about 1 ms on a slow machine. */
const SLICE_BYTES = 1 << 20;
/** For copying in one frame. */
const FRAME_MS = 4;

export class WordTexture {
  /** One word that nobody reads, until there is a map. */
  texture = textureOf(new Uint32Array(1), 1, 1);
  #next: { stage: ShadowStage; texture: DataTexture; from: DataTexture; rows: number } | undefined;

  constructor(private readonly renderer: WebGLRenderer) {}

  get bytes(): number {
    return (this.texture.image.data as Uint32Array).byteLength;
  }

  get isBusy(): boolean {
    return this.#next !== undefined;
  }

  /**
   * Bring this map up from now on, in place of one that is still on its way.
   *
   * @throws Problem if this device has no texture as large.
   */
  start(stage: ShadowStage): void {
    const width = 2 ** stage.widthBits;
    const rows = stage.words.length / width;
    const most = this.renderer.capabilities.maxTextureSize;
    if (width > most || rows > most) {
      const size = `${Math.round(stage.words.byteLength / 2 ** 20)} MB`;
      throw new Problem(
        "webgl",
        `The shadows are too fine for these graphics (${size} in one texture). Coarser ones are shown.`,
      );
    }
    this.#next?.texture.dispose();
    const texture = textureOf(stage.words, width, rows);
    texture.source.dataReady = false; // rows come one after the other
    this.#next = { stage, texture, from: textureOf(stage.words, width, rows), rows: 0 };
  }

  /** Bring a frame's share up; the map whose last one it was, which is `texture` from now on. */
  advance(): ShadowStage | null {
    const next = this.#next;
    if (!next) return null;
    const begin = performance.now();
    const { width, height } = next.from.image;
    const step = Math.max(1, Math.floor(SLICE_BYTES / (4 * width)));
    while (next.rows < height) {
      if (performance.now() - begin > FRAME_MS) return null;
      const end = Math.min(height, next.rows + step);
      const slice = new Box2(new Vector2(0, next.rows), new Vector2(width, end));
      this.renderer.copyTextureToTexture(next.from, next.texture, slice, slice.min);
      next.rows = end;
    }
    this.#next = undefined;
    this.texture.dispose();
    this.texture = next.texture;
    this.texture.source.dataReady = true; // after a loss of the graphics it goes up as a whole
    return next.stage;
  }

  /** The graphics are lost: what was on its way begins anew. */
  restart(): void {
    if (this.#next) this.#next.rows = 0;
  }
}

export function textureOf(data: Uint32Array<ArrayBuffer>, width: number, height: number): DataTexture {
  const texture = new DataTexture(data, width, height, RedIntegerFormat, UnsignedIntType);
  texture.internalFormat = "R32UI";
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.unpackAlignment = 4;
  texture.needsUpdate = true;
  return texture;
}
