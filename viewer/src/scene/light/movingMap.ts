/**
 * An ordinary shadow map of what is not among the casters of the precomputed one: refined live, or added later.
 *
 * It is drawn along the light's own projection, from the picture's own eye, so that every layer places its vertices
 * as for the picture, and holds depths as the trees do. A point's six lie side by side.
 */
import {
  Camera,
  Color,
  Matrix4,
  NearestFilter,
  RedIntegerFormat,
  type Scene,
  UnsignedIntType,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import type { Projection, Row } from "../../format/light";
import { fromFrame } from "../frame";
import type { Layer } from "../layer";
import type { SceneLight } from "./sceneLight";

/** A side, of one projection; a point has six, half as large. */
const PIXELS = 2048;
/** Nearest that is drawn, of the distance of the farthest. */
const NEAREST = 1e-4;

export class MovingMap {
  readonly #target: WebGLRenderTarget;
  readonly #camera = new Camera();
  readonly #isCube: boolean;
  readonly #pixels: number;
  /** What it was drawn of. */
  #drawn = "";

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly light: SceneLight,
    /** Those that move. */
    private readonly layers: readonly Layer[],
  ) {
    this.#isCube = light.info.kind === "cube";
    this.#pixels = this.#isCube ? PIXELS / 2 : PIXELS;
    const [columns, rows] = this.#isCube ? [3, 2] : [1, 1];
    this.#target = new WebGLRenderTarget(columns * this.#pixels, rows * this.#pixels, {
      format: RedIntegerFormat,
      type: UnsignedIntType,
      internalFormat: "R32UI",
      minFilter: NearestFilter,
      magFilter: NearestFilter,
    });
    this.#camera.matrixAutoUpdate = false;
    this.#camera.matrixWorldAutoUpdate = false;
    const { uniforms } = light;
    uniforms.movingPixels.value = this.#pixels;
    uniforms.movingSteps.value = this.#target.texture;
    light.isMoving = true;
  }

  /** Draw it anew if it is another now. The layers wear what casts, and all else is hidden. */
  draw(scene: Scene, eye: Camera): void {
    const { uniforms } = this.light;
    const versions = this.layers.map(({ version, group }) => `${version} ${group.visible}`);
    const wanted = [uniforms.movingRow.value, uniforms.shadowLevels.value, ...versions].join(",");
    if (wanted === this.#drawn) return;
    this.#drawn = wanted;
    this.#clear();
    const rows = this.#isCube ? [0, 1, 2, 3, 4, 5] : [uniforms.movingRow.value];
    for (const row of rows) {
      this.#aim(eye, this.light.info.projections[row]!);
      uniforms.castRow.value = row;
      const tile = this.#isCube ? row : 0;
      this.#target.viewport.set(
        (tile % 3) * this.#pixels,
        Math.floor(tile / 3) * this.#pixels,
        this.#pixels,
        this.#pixels,
      );
      this.renderer.setRenderTarget(this.#target);
      this.renderer.autoClear = false;
      this.renderer.render(scene, this.#camera);
    }
    this.renderer.setRenderTarget(null);
    this.renderer.autoClear = true;
  }

  /** The graphics are lost, and what was on them. */
  clear(): void {
    this.#drawn = "";
  }

  /** The largest W in the scene. */
  #farthest(w: Row): number {
    const { frame, halfBox } = this.light;
    const middle = fromFrame(frame, [0, 0, 0]);
    const reach = halfBox.map((half, a) => Math.abs(w[a]! * half) / frame.scale);
    const at = middle.reduce((sum, value, a) => sum + w[a]! * value, w[3]);
    return Math.max(at + reach[0]! + reach[1]! + reach[2]!, Number.MIN_VALUE);
  }

  #clear(): void {
    const { renderer } = this;
    const before = renderer.getClearColor(new Color());
    renderer.setRenderTarget(this.#target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    renderer.setRenderTarget(null);
    renderer.setClearColor(before, 1);
  }

  /** From the picture's eye to the light's window: clip = (2 X - W, 2 Y - W, depth, W). */
  #aim(eye: Camera, [x, y, z, w]: Projection): void {
    const { frame } = this.light;
    const fromWorld = new Matrix4().set(...x, ...y, ...z, ...w);
    const [tx, ty, tz] = fromFrame(frame, [0, 0, 0]);
    const s = 1 / frame.scale;
    const toWorld = new Matrix4().set(s, 0, 0, tx, 0, s, 0, ty, 0, 0, s, tz, 0, 0, 0, 1);
    const seen = fromWorld.multiply(toWorld).multiply(eye.matrixWorld);
    const isParallel = w[0] === 0 && w[1] === 0 && w[2] === 0;
    // of a perspective any depth that grows with W, by far and near ends that hold all
    const far = isParallel ? 1 : this.#farthest(w);
    const near = NEAREST * far;
    const [a, b] = isParallel ? [0, 0] : [(far + near) / (far - near), (-2 * far * near) / (far - near)];
    const clip = isParallel
      ? new Matrix4().set(2, 0, 0, -1, 0, 2, 0, -1, 0, 0, 2, -1, 0, 0, 0, 1)
      : new Matrix4().set(2, 0, 0, -1, 0, 2, 0, -1, 0, 0, 0, a, 0, 0, 0, 1);
    this.#camera.projectionMatrix.multiplyMatrices(clip, seen);
    this.#camera.projectionMatrix.elements[14]! += b;
    this.#camera.projectionMatrixInverse.copy(this.#camera.projectionMatrix).invert();
    this.#camera.matrixWorld.copy(eye.matrixWorld);
    this.#camera.matrixWorldInverse.copy(eye.matrixWorldInverse);
  }
}
