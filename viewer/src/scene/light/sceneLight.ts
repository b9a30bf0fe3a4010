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
import type { LightInfo, Row } from "../../format/light";
import type { ShadowStage } from "../../stream/shadowStage";
import type { Frame } from "../frame";
import type { LightLook } from "./look";
import { SEEN_TEXELS, SeenProjection, towardsOf, writeLight } from "./seenProjection";
import type { LightShader } from "./shader";
import { textureOf, WordTexture } from "./wordTexture";

/** Images of an area light that a pixel asks for: while things move, and at rest. */
const SAMPLES = { moving: 8, resting: 1024, software: 16 } as const;
const KINDS = { one: 0, cube: 1, path: 2, area: 3 } as const;

export class SceneLight implements LightShader {
  readonly uniforms = makeUniforms();
  readonly #words: WordTexture;
  readonly #projections: SeenProjection[];
  readonly #seen: Float32Array<ArrayBuffer>;
  readonly #reference = new Vector3();
  readonly #middle: Row;
  #levels = 0;
  #isOn = true;
  /** As `light.glsl` says. */
  defines: Readonly<Record<string, number>> = {
    LIGHT_KIND: 0,
    LIGHT_RADIUS: 0,
    LIGHT_FILTERED: 0,
    LIGHT_MOVES: 0,
  };
  /** Other shaders are needed now. */
  onChange: () => void = () => {};

  constructor(
    renderer: WebGLRenderer,
    readonly info: LightInfo,
    readonly frame: Frame,
    /** Of the scene, half its sides in its frame. */
    readonly halfBox: Triple,
    private readonly isSoftware: boolean,
  ) {
    this.#words = new WordTexture(renderer);
    const rows = info.projections.length + 1; // the last is the middle of an area
    this.#seen = new Float32Array(4 * SEEN_TEXELS * rows);
    const texture = new DataTexture(this.#seen, SEEN_TEXELS, rows, RGBAFormat, FloatType);
    texture.minFilter = texture.magFilter = NearestFilter;
    this.uniforms.lightProjections.value = texture;
    this.uniforms.lightImages.value = info.images;
    this.uniforms.lightSpread.value = info.spread;
    this.uniforms.lightCone.value = info.cone?.cosine ?? -2;
    this.#projections = [];
    this.#middle = info.middle ?? towardsOf(info.projections[0]!);
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

  /** By how many times its depth what is shown may be beside what casts: else it would be in its shadow. */
  set lift(lift: number) {
    this.uniforms.lightLift.value = lift;
  }

  set look({ isOn, filter, time }: LightLook) {
    const { uniforms, info } = this;
    const isSoft = info.kind === "area" && filter === "soft";
    uniforms.lightTime.value = Math.max(0, Math.min(info.images - 1, time));
    uniforms.movingRow.value = info.kind === "cube" ? 0 : Math.round(uniforms.lightTime.value);
    this.#isOn = isOn;
    this.#define({
      LIGHT_KIND: info.kind === "area" && !isSoft ? KINDS.one : KINDS[info.kind],
      LIGHT_RADIUS: filter === "5x5" ? 2 : filter === "3x3" ? 1 : 0,
      LIGHT_FILTERED: Number(filter === "smooth"),
    });
  }

  /** Some layers cast by an ordinary shadow map. */
  set isMoving(isMoving: boolean) {
    this.#define({ LIGHT_MOVES: Number(isMoving) });
  }

  /** Have shaders made anew where they are others now. */
  #define(change: Readonly<Record<string, number>>): void {
    const { IS_LIT, ...kept } = this.defines;
    const defines = { ...kept, ...change, ...(this.#isOn && this.isThere ? { IS_LIT: 1 } : {}) };
    if (JSON.stringify(defines) === JSON.stringify(this.defines)) return;
    this.defines = defines;
    this.onChange();
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
    this.#define({});
  }

  /** What is drawn next is seen by this camera. */
  follow(camera: Camera): void {
    const reference = this.#reference.setFromMatrixPosition(camera.matrixWorld);
    const [x, y, z] = this.halfBox;
    reference.clamp(new Vector3(-x, -y, -z), new Vector3(x, y, z));
    this.#projections.forEach((projection, i) => {
      projection.write(camera.matrixWorld, reference, this.#seen, 4 * SEEN_TEXELS * i);
    });
    this.#writeMiddle(camera);
    this.uniforms.lightProjections.value.needsUpdate = true;
    this.uniforms.lightReference.value.copy(reference).applyMatrix4(camera.matrixWorldInverse);
  }

  /** Where an area's cosine is measured to, and its axis. */
  #writeMiddle({ matrixWorld }: Camera): void {
    const { info, frame } = this;
    const at = 4 * SEEN_TEXELS * info.projections.length;
    writeLight(this.#middle, frame, matrixWorld, this.#seen, at + 20);
    if (info.cone) writeLight([...info.cone.axis, 0], frame, matrixWorld, this.#seen, at + 12);
  }

  /** The graphics are lost, and what was on its way to them. */
  clear(): void {
    this.#words.restart();
  }
}

function makeUniforms() {
  const nothing = textureOf(new Uint32Array(1), 1, 1);
  return {
    lightProjections: { value: new DataTexture() },
    lightReference: { value: new Vector3() },
    lightImages: { value: 1 },
    lightMissing: { value: 0 },
    lightSpread: { value: 0 },
    lightTime: { value: 0 },
    lightSamples: { value: 1 },
    lightLift: { value: 0 },
    lightCone: { value: -2 },
    shadowWords: { value: nothing },
    shadowWidthBits: { value: 0 },
    shadowLevels: { value: 0 },
    shadowScales: { value: new Uint32Array(120) },
    shadowRoots: { value: new Uint32Array(12) },
    castRow: { value: 0 },
    movingRow: { value: 0 },
    movingPixels: { value: 1 },
    movingSteps: { value: nothing as Texture },
  };
}
