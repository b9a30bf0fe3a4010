/** The picture: camera, layers, budgets and the one loop, which runs only while something changes. */
import type { Vector3 } from "three";
import type { LightInfo } from "../format/light";
import type { Asset } from "../stream/asset";
import type { Streamer } from "../stream/streamer";
import { type Box, boxOf, type Frame, frameOf, halfBoxOf } from "./frame";
import { FrameClock } from "./frameClock";
import type { InsetPlace } from "./inset";
import type { Layer, Look } from "./layer";
import { SceneLight } from "./light/sceneLight";
import { MotionBudget } from "./motionBudget";
import { type CameraState, Navigation } from "./navigation";
import { Painter } from "./painter";
import { PatchFeed } from "./patchFeed";
import type { Turn } from "./turn";

export interface StageOptions {
  readonly errorPx: number;
  readonly triangleBudget: number;
  readonly isStill: boolean;
  readonly onFrame: (stage: Stage) => void;
  readonly onLost: () => void;
  readonly onRestored: () => void;
}

/** What is shown: the patches of an asset, or a layer of another kind, made when the frame of all is known. */
export type Part = { readonly name: string; readonly isVisible: boolean } & (
  | { readonly asset: Asset }
  | { readonly box: Box; readonly makeLayer: (frame: Frame) => Layer }
);

/** Coarser surfaces than this, in pixels, may be in their own finer ones' shadow; they do not stay. */
const MOST_LIFT_PX = 8;

export class Stage {
  readonly navigation: Navigation;
  readonly painter: Painter;
  readonly clock = new FrameClock();
  readonly motion = new MotionBudget();
  /** Moments since the navigation began, in milliseconds. */
  readonly moments: { firstPicture?: number; firstSettled?: number } = {};
  /** Error aimed at, in pixels. */
  targetPx: number;
  triangleBudget: number;
  /** Largest screen error in view, in pixels. */
  errorPx = Number.POSITIVE_INFINITY;
  isLost = false;
  /** That of the scene, where it has one. */
  light: SceneLight | undefined;
  /** More of the light is on its way. */
  isLightComing = false;
  #feed: PatchFeed | undefined;
  #handle = 0;
  #waiting: (() => void)[] = [];
  #isIdle = false;

  /** @throws Problem if the browser has no WebGL2. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly options: StageOptions,
  ) {
    this.painter = new Painter(canvas);
    this.targetPx = options.errorPx;
    this.triangleBudget = options.triangleBudget;
    this.navigation = new Navigation(canvas, () => this.invalidate(), options.isStill);
    canvas.addEventListener("webglcontextlost", () => this.#lose());
    canvas.addEventListener("webglcontextrestored", () => this.#restore());
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  get layers(): readonly Layer[] {
    return this.painter.layers;
  }

  /** Show these parts; the names are the layers'. */
  open(streamer: Streamer, parts: readonly Part[]): void {
    const boxes = parts.map((part) => ("asset" in part ? boxOf(part.asset.info) : part.box));
    const frame = frameOf(boxes);
    this.navigation.frame = frame;
    const halfBox = halfBoxOf(boxes, frame);
    this.navigation.halfBox = halfBox;
    this.painter.inset.halfBox = halfBox;
    const feed = new PatchFeed(streamer);
    this.#feed = feed;
    const { materials } = this.painter;
    for (const part of parts) {
      const layer =
        "asset" in part ? feed.open(part.name, part.asset, frame, materials) : part.makeLayer(frame);
      layer.group.visible = part.isVisible;
      layer.isStill = this.navigation.isStill;
      this.painter.add(layer);
    }
    this.invalidate();
  }

  /** Have a light shine on all that is shown; some layers cast by an ordinary shadow map. */
  shine(info: LightInfo, moving: readonly string[]): SceneLight {
    const { painter } = this;
    const { frame, halfBox } = this.navigation;
    this.light = new SceneLight(painter.renderer, info, frame, halfBox, painter.isSoftware);
    painter.shine(
      this.light,
      this.layers.filter(({ name }) => moving.includes(name)),
    );
    return this.light;
  }

  /** Draw a frame soon. */
  invalidate(): void {
    this.#isIdle = false;
    if (this.#handle === 0 && !this.isLost) this.#handle = requestAnimationFrame((now) => this.#tick(now));
  }

  /** Settles when nothing moves, nothing is on its way, and the picture is as good as asked for. */
  idle(): Promise<void> {
    if (this.#isIdle) return Promise.resolve();
    return new Promise((resolve) => this.#waiting.push(resolve));
  }

  get isIdle(): boolean {
    return this.#isIdle;
  }

  set isStill(isStill: boolean) {
    this.navigation.isStill = isStill;
    for (const layer of this.layers) layer.isStill = isStill;
  }

  set look(look: Look) {
    this.painter.look = look;
    this.invalidate();
  }

  /** Where on the canvas the picture from elsewhere is, null for nowhere, and from where it looks. */
  setInset(place: InsetPlace | null, turn: Turn): void {
    this.painter.inset.place = place;
    this.painter.inset.turn = turn;
    this.invalidate();
  }

  setCamera(state: CameraState, isSmooth = false): void {
    this.navigation.setCamera(state, isSmooth);
    this.invalidate();
  }

  /** The point under a place of the page, or null over the background. */
  pick(clientX: number, clientY: number): Vector3 | null {
    const box = this.canvas.getBoundingClientRect();
    const x = (clientX - box.left) / box.width;
    const y = (clientY - box.top) / box.height;
    return this.isLost ? null : this.painter.pick(x, y, this.navigation.camera);
  }

  /** Bring the pivot's depth to that of the surface at this place of the page, if there is one. */
  anchor(clientX: number, clientY: number): void {
    const point = this.pick(clientX, clientY);
    if (!point) return;
    const depth = -point.applyMatrix4(this.navigation.camera.matrixWorldInverse).z;
    this.navigation.anchor(depth);
  }

  /** The picture as a PNG, without anything of the page. */
  screenshot(): Promise<Blob> {
    this.#paint();
    return new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) =>
        blob ? resolve(blob) : reject(new Error("The picture could not be saved.")),
      );
    });
  }

  #tick(now: number): void {
    this.#handle = 0;
    const { clock, painter, navigation } = this;
    const interval = clock.begin(now);
    if (interval === null) this.motion.restart();
    else this.motion.frame(interval, painter.drawn.triangles, clock.isMoving);
    const hasMoved = navigation.controls.update(clock.elapsed / 1000);
    if (hasMoved) clock.move();
    this.#prepare();
    if (this.layers.length) this.#draw(); // before, the page's own background is enough
    const isFading = this.layers.some((layer) => layer.isFading);
    const isBusy = this.light?.isBusy || this.#feed?.hasMore;
    clock.isOn = hasMoved || isFading || clock.isMoving || isBusy === true;
    if (clock.isOn) this.invalidate();
    else if (this.#isSettled) this.#rest();
    this.options.onFrame(this);
  }

  get #isSettled(): boolean {
    return this.layers.length > 0 && !this.isLightComing && this.layers.every((layer) => layer.isSettled);
  }

  /** All that a frame needs before it is drawn. */
  #prepare(): void {
    const { camera } = this.navigation;
    this.navigation.fitClipping();
    camera.updateMatrixWorld();
    this.#feed?.begin();
    this.#choose();
    for (const layer of this.layers) layer.show(this.clock.elapsed);
    this.#feed?.finish();
    this.#prepareLight();
  }

  #prepareLight(): void {
    const { light, navigation, clock } = this;
    if (!light) return;
    light.advance(clock.isMoving);
    const pixelsPerRadian = this.canvas.height / (2 * Math.tan((navigation.camera.fov * Math.PI) / 360));
    const errorPx = Math.max(this.targetPx, Math.min(this.errorPx, MOST_LIFT_PX));
    light.lift = errorPx / pixelsPerRadian;
  }

  /** Each layer its share of the budgets, what one leaves passed on to the next. */
  #choose(): void {
    const visible = this.layers.filter((layer) => layer.group.visible);
    let triangles = this.triangleBudget;
    if (this.clock.isMoving) triangles = Math.min(triangles, this.motion.triangles);
    let bytes = this.#feed?.cutBytes ?? 0;
    this.errorPx = 0;
    visible.forEach((layer, i) => {
      const share = visible.length - i;
      const allowed = { triangles: triangles / share, bytes: bytes / share };
      const spent = layer.choose(this.navigation.camera, this.canvas.height, this.targetPx, allowed);
      triangles -= spent.triangles;
      bytes -= spent.bytes;
      this.errorPx = Math.max(this.errorPx, layer.errorPx);
    });
  }

  #paint(): void {
    const { camera, controls } = this.navigation;
    this.painter.draw(camera, controls.distance);
  }

  #draw(): void {
    const { painter, clock } = this;
    this.#paint();
    if (clock.isMoving && painter.isSoftware) painter.wait();
    clock.end(performance.now());
    if (painter.drawn.patches > 0) this.moments.firstPicture ??= performance.now();
  }

  #rest(): void {
    this.#isIdle = true;
    for (const resolve of this.#waiting.splice(0)) resolve();
    if (this.moments.firstSettled === undefined) this.painter.warmUp(this.navigation.camera);
    this.moments.firstSettled ??= performance.now();
  }

  #resize(): void {
    this.navigation.camera.aspect = this.painter.resize();
    this.navigation.camera.updateProjectionMatrix();
    this.invalidate();
  }

  /** The GPU is gone, and what was on it. Three prevents the default, so the browser may give it back. */
  #lose(): void {
    this.isLost = true;
    cancelAnimationFrame(this.#handle);
    this.#handle = 0;
    for (const layer of this.layers) layer.clear();
    this.#feed?.forgetAll();
    this.painter.clear();
    this.options.onLost();
  }

  #restore(): void {
    this.isLost = false;
    this.options.onRestored();
    this.invalidate();
  }
}
