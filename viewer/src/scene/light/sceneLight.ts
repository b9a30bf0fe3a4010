/** The light of a scene: its precomputed shadows on the GPU, and how they are looked up. */
import {
  type Camera,
  DataTexture,
  FloatType,
  NearestFilter,
  RGBAFormat,
  type Texture,
  Vector3,
  type WebGLRenderer,
} from "three";
import type { Triple } from "../../format/graph";
import type { LightInfo } from "../../format/light";
import type { ShadowStage } from "../../stream/shadowStage";
import type { Frame } from "../frame";
import type { LightLook } from "./look";
import { SEEN_TEXELS, SeenProjection, towardsOf } from "./seenProjection";
import type { LightUniforms } from "./shader";
import { textureOf, WordTexture } from "./wordTexture";

/** Images of an area light that a pixel asks for: while things move, and at rest. */
const SAMPLES = { moving: 8, resting: 1024, software: 16 } as const;
const KINDS = { one: 0, cube: 1, path: 2, area: 3 } as const;

export class SceneLight {
  readonly uniforms = makeUniforms();
  readonly #words: WordTexture;
  readonly #projections: SeenProjection[];
  readonly #seen: Float32Array<ArrayBuffer>;
  readonly #reference = new Vector3();
  #levels = 0;
  #isWanted = true;

  constructor(
    renderer: WebGLRenderer,
    readonly info: LightInfo,
    readonly frame: Frame,
    /** Of the scene, half its sides in its frame. */
    readonly halfBox: Triple,
    private readonly isSoftware: boolean,
  ) {
    this.#words = new WordTexture(renderer);
    const rows = info.projections.length;
    this.#seen = new Float32Array(4 * SEEN_TEXELS * rows);
    const texture = new DataTexture(this.#seen, SEEN_TEXELS, rows, RGBAFormat, FloatType);
    texture.minFilter = texture.magFilter = NearestFilter;
    this.uniforms.lightProjections.value = texture;
    this.uniforms.lightKind.value = KINDS[info.kind];
    this.uniforms.lightImages.value = info.images;
    this.uniforms.lightCone.value = info.cosine ?? -2;
    this.#projections = [];
  }

  /** A map has come; it is shown when it is on the GPU. */
  take(stage: ShadowStage): void {
    this.#words.start(stage);
  }

  /** There is more to bring to the GPU than one frame takes. */
  get isBusy(): boolean {
    return this.#words.isBusy;
  }

  /** Of GPU memory. */
  get bytes(): number {
    return this.#words.bytes;
  }

  /** Some map is shown, if a light is. */
  get isThere(): boolean {
    return this.#levels > 0;
  }

  set look({ isOn, filter, time }: LightLook) {
    const { uniforms, info } = this;
    this.#isWanted = isOn;
    uniforms.lightIs.value = isOn && this.isThere;
    uniforms.lightIsFiltered.value = filter === "smooth";
    uniforms.lightRadius.value = filter === "5x5" ? 2 : filter === "3x3" ? 1 : 0;
    uniforms.lightTime.value = Math.max(0, Math.min(info.images - 1, time));
    uniforms.movingRow.value = Math.round(uniforms.lightTime.value);
  }

  /** Once a frame: bring up a slice; whether it was the last of a map. */
  advance(isMoving: boolean): boolean {
    const most = this.isSoftware ? SAMPLES.software : SAMPLES[isMoving ? "moving" : "resting"];
    this.uniforms.lightSamples.value = Math.min(this.info.images, most);
    const stage = this.#words.advance();
    if (!stage) return false;
    this.#show(stage);
    return true;
  }

  #show(stage: ShadowStage): void {
    const { uniforms, info } = this;
    this.#levels = stage.levels;
    uniforms.lightIs.value = this.#isWanted;
    this.#projections.length = 0;
    for (const projection of info.projections) {
      const towards = towardsOf(projection);
      this.#projections.push(new SeenProjection(projection, 2 ** stage.levels, towards, this.frame));
    }
    uniforms.shadowWords.value = this.#words.texture;
    uniforms.shadowWidthBits.value = stage.widthBits;
    uniforms.shadowLevels.value = stage.levels;
    uniforms.shadowScales.value = stage.scales;
    uniforms.shadowRoots.value = stage.roots;
    uniforms.lightMissing.value = info.levels - stage.levels;
  }

  /** What is drawn next is seen by this camera. */
  follow(camera: Camera): void {
    const reference = this.#reference.setFromMatrixPosition(camera.matrixWorld);
    const [x, y, z] = this.halfBox;
    reference.clamp(new Vector3(-x, -y, -z), new Vector3(x, y, z));
    this.#projections.forEach((projection, i) => {
      projection.write(camera.matrixWorld, reference, this.#seen, 4 * SEEN_TEXELS * i);
    });
    this.uniforms.lightProjections.value.needsUpdate = true;
    this.uniforms.lightReference.value.copy(reference).applyMatrix4(camera.matrixWorldInverse);
  }

  /** The graphics are lost, and what was on its way to them. */
  clear(): void {
    this.#words.restart();
  }
}

function makeUniforms() {
  const nothing = textureOf(new Uint32Array(1), 1, 1);
  return {
    lightIs: { value: false },
    lightProjections: { value: new DataTexture() },
    lightReference: { value: new Vector3() },
    lightKind: { value: 0 },
    lightRadius: { value: 0 },
    lightIsFiltered: { value: false },
    lightImages: { value: 1 },
    lightMissing: { value: 0 },
    lightTime: { value: 0 },
    lightSamples: { value: 1 },
    lightCone: { value: -2 },
    shadowWords: { value: nothing },
    shadowWidthBits: { value: 0 },
    shadowLevels: { value: 0 },
    shadowScales: { value: new Uint32Array(120) },
    shadowRoots: { value: new Uint32Array(12) },
    movingIs: { value: false },
    castRow: { value: 0 },
    movingRow: { value: 0 },
    movingPixels: { value: 1 },
    movingSteps: { value: nothing as Texture },
  } satisfies LightUniforms;
}
