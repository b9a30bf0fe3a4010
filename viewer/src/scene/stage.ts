/** The picture: renderer, camera, layers and the one loop, which runs only while something changes. */
import { type Material, Scene, type Vector3, type WebGLRenderer } from "three";
import type { Asset } from "../stream/asset";
import type { NodeAt, Streamer } from "../stream/streamer";
import { Background, type BackgroundColours } from "./background";
import { MAX_PIXEL_RATIO } from "./device";
import { type Frame, frameOf, halfBoxOf } from "./frame";
import { Layer } from "./layer";
import { makeMaterials } from "./material";
import { MotionBudget } from "./motionBudget";
import { type CameraState, Navigation } from "./navigation";
import { Picker } from "./picking";
import { makeGraphics, waitUntilDrawn } from "./renderer";
import { SphereLines } from "./spheres";
import { viewOf } from "./view";

export interface StageOptions {
  readonly errorPx: number;
  readonly triangleBudget: number;
  readonly isStill: boolean;
  readonly onFrame: (stage: Stage) => void;
  readonly onLost: () => void;
  readonly onRestored: () => void;
}

const FADE_MS = 150;
/** What may be handed to the GPU in one frame: about 2 ms of copying on a slow machine. */
const UPLOAD_BYTES = 2 << 20;
const UPLOAD_MS = 4;
/** The share of the memory budget that a cut may ask for; the rest holds what fades out, and the way back. */
const CUT_SHARE = 0.8;
/** How long after the last movement the camera counts as moving. */
const SETTLE_MS = 180;
const FRAME_TIMES_KEPT = 600;

export class Stage {
  readonly navigation: Navigation;
  readonly renderer: WebGLRenderer;
  readonly layers: Layer[] = [];
  /** Milliseconds between frames that followed each other at once, the latest last. */
  readonly frameTimes: number[] = [];
  /** Moments since the navigation began, in milliseconds. */
  readonly moments: { firstPicture?: number; firstSettled?: number } = {};
  readonly motion = new MotionBudget();
  /** Error aimed at, in pixels. */
  targetPx: number;
  triangleBudget: number;
  drawnTriangles = 0;
  drawnPatches = 0;
  /** Largest screen error in view, in pixels. */
  errorPx = Number.POSITIVE_INFINITY;
  isLost = false;
  readonly #scene = new Scene();
  readonly #materials = makeMaterials();
  readonly #background = new Background();
  readonly #spheres = new SphereLines();
  readonly #picker: Picker;
  readonly #isSoftware: boolean;
  #streamer: Streamer | undefined;
  #frame: Frame = { centre: [0, 0, 0], scale: 1 };
  #areSpheresOn = false;
  #isWireframe = false;
  #handle = 0;
  #last = 0;
  #isConsecutive = false;
  #lastMoved = Number.NEGATIVE_INFINITY;
  #waiting: (() => void)[] = [];
  #isIdle = false;

  /** @throws Problem if the browser has no WebGL2. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly options: StageOptions,
  ) {
    const { renderer, isSoftware } = makeGraphics(canvas);
    this.renderer = renderer;
    this.#isSoftware = isSoftware;
    this.renderer.info.autoReset = false;
    this.targetPx = options.errorPx;
    this.triangleBudget = options.triangleBudget;
    this.navigation = new Navigation(canvas, () => this.invalidate(), options.isStill);
    this.#picker = new Picker(this.renderer, this.#materials);
    this.#scene.matrixWorldAutoUpdate = false;
    this.#scene.onBeforeRender = (_renderer, _scene, camera) => {
      for (const layer of this.layers) layer.follow(camera);
    };
    this.#scene.add(this.#background.mesh, this.#spheres.lines);
    canvas.addEventListener("webglcontextlost", () => this.#lose());
    canvas.addEventListener("webglcontextrestored", () => this.#restore());
    canvas.addEventListener("wheel", (event) => this.#anchorAt(event), { capture: true, passive: true });
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  /** Show these assets; the names are the layers'. */
  open(streamer: Streamer, assets: readonly { name: string; asset: Asset; isVisible: boolean }[]): void {
    this.#streamer = streamer;
    this.#frame = frameOf(assets.map(({ asset }) => asset));
    for (const { name, asset, isVisible } of assets) {
      const fade = this.navigation.isStill ? 0 : FADE_MS;
      const layer = new Layer(name, asset, streamer.add(asset), this.#frame, this.#materials, fade);
      layer.group.visible = isVisible;
      this.layers.push(layer);
      this.#scene.add(layer.group);
    }
    this.navigation.frame = this.#frame;
    this.navigation.halfBox = halfBoxOf(
      assets.map(({ asset }) => asset),
      this.#frame,
    );
    this.invalidate();
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
    for (const layer of this.layers) layer.fade.duration = isStill ? 0 : FADE_MS;
  }

  set background(colours: BackgroundColours) {
    this.#background.colours = colours;
    this.invalidate();
  }

  set areColoursOn(areOn: boolean) {
    for (const layer of this.layers) layer.areColoursOn = areOn;
    this.invalidate();
  }

  set arePatchesTinted(areTinted: boolean) {
    this.#materials.uniforms.hasTint.value = areTinted;
    this.invalidate();
  }

  set isWireframe(isOn: boolean) {
    this.#isWireframe = isOn;
    this.#materials.solid.polygonOffset = isOn;
    this.#materials.fading.polygonOffset = isOn;
    this.invalidate();
  }

  set areSpheresOn(areOn: boolean) {
    this.#areSpheresOn = areOn;
    this.#spheres.lines.visible = areOn;
    this.invalidate();
  }

  setCamera(state: CameraState, isSmooth = false): void {
    this.navigation.setCamera(state, isSmooth);
    this.invalidate();
  }

  /** The point under a place of the page, or null over the background. */
  pick(clientX: number, clientY: number): Vector3 | null {
    const box = this.canvas.getBoundingClientRect();
    return this.#pickAt((clientX - box.left) / box.width, (clientY - box.top) / box.height);
  }

  #pickAt(x: number, y: number): Vector3 | null {
    const hidden = [this.#background.mesh, this.#spheres.lines];
    return this.#picker.pick(x, y, this.#scene, this.navigation.camera, hidden);
  }

  /** The picture as a PNG, without anything of the page. */
  screenshot(): Promise<Blob> {
    this.#render();
    return new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) =>
        blob ? resolve(blob) : reject(new Error("The picture could not be saved.")),
      );
    });
  }

  #tick(now: number): void {
    this.#handle = 0;
    const interval = now - this.#last;
    this.#last = now;
    if (this.#isConsecutive) this.#note(interval);
    else this.motion.restart();
    // after a rest the clock begins anew: a long pause is not a long step
    const elapsed = this.#isConsecutive ? Math.min(interval, 100) : 16;
    const hasMoved = this.navigation.controls.update(elapsed / 1000);
    if (hasMoved) this.#lastMoved = now;
    const isMoving = now - this.#lastMoved < SETTLE_MS;
    this.#prepare(elapsed, isMoving);
    if (this.layers.length) this.#render(); // before, the page's own background is enough
    if (isMoving && this.#isSoftware) waitUntilDrawn(this.renderer);
    const isFading = this.layers.some((layer) => layer.fade.isMoving);
    this.#isConsecutive = hasMoved || isFading || isMoving || this.#hasUploads;
    if (this.#isConsecutive) this.invalidate();
    else if (this.#streamer?.isSettled) this.#rest();
    this.options.onFrame(this);
  }

  #hasUploads = false;

  /** All that a frame needs before it is drawn. */
  #prepare(elapsed: number, isMoving: boolean): void {
    const streamer = this.#streamer;
    this.navigation.fitClipping();
    this.navigation.camera.updateMatrixWorld();
    if (!streamer) return;
    streamer.beginFrame();
    this.#upload(streamer);
    this.#select(streamer, isMoving);
    for (const layer of this.layers) {
      layer.show(elapsed, (node) => streamer.touch({ asset: layer.index, node }));
    }
    for (const { asset, node } of streamer.evict()) this.layers[asset]?.removeNode(node);
    if (this.#areSpheresOn) this.#spheres.update(this.layers.filter((layer) => layer.group.visible));
  }

  #upload(streamer: Streamer): void {
    const begin = performance.now();
    let bytes = 0;
    this.#hasUploads = false;
    while (bytes < UPLOAD_BYTES && performance.now() - begin < UPLOAD_MS) {
      const ready = streamer.take();
      if (!ready) return;
      bytes += ready.bytes;
      this.layers[ready.asset]?.addNode(ready.node, ready.patches);
    }
    this.#hasUploads = true;
  }

  /** One cut a layer, what one leaves of the budgets passed on to the next; what is missing is asked for. */
  #select(streamer: Streamer, isMoving: boolean): void {
    const visible = this.layers.filter((layer) => layer.group.visible);
    let triangles = isMoving ? Math.min(this.triangleBudget, this.motion.triangles) : this.triangleBudget;
    let bytes = CUT_SHARE * streamer.budgetBytes;
    const wanted: (NodeAt & { key: number })[] = [];
    this.errorPx = 0;
    visible.forEach((layer, i) => {
      const share = visible.length - i;
      const view = viewOf(this.navigation.camera, this.canvas.height, layer.frame, layer.asset);
      layer.select(view, {
        errorPx: this.targetPx,
        triangleBudget: triangles / share,
        byteBudget: bytes / share,
      });
      const { selection } = layer;
      triangles -= selection.triangles;
      bytes -= selection.heldBytes;
      this.errorPx = Math.max(this.errorPx, selection.errorPx);
      for (let w = 0; w < selection.wantedCount; w++) {
        const node = selection.wanted[w]!;
        wanted.push({ asset: layer.index, node, key: selection.screenError(node) });
      }
    });
    if (visible.length > 1) wanted.sort((a, b) => b.key - a.key);
    streamer.want(wanted);
  }

  #render(): void {
    const { renderer } = this;
    for (const layer of this.layers) {
      layer.drawnPatches = 0;
      layer.drawnTriangles = 0;
    }
    renderer.info.reset();
    renderer.autoClear = true;
    renderer.render(this.#scene, this.navigation.camera);
    this.drawnPatches = this.layers.reduce((sum, layer) => sum + layer.drawnPatches, 0);
    this.drawnTriangles = this.layers.reduce((sum, layer) => sum + layer.drawnTriangles, 0);
    if (this.#isWireframe) this.#renderOver(this.#materials.wire);
    if (this.drawnPatches > 0) this.moments.firstPicture ??= performance.now();
  }

  /** Make what the first fade and the first pick would make: 180 ms a shader where the processor draws. */
  #warmUp(): void {
    const { renderer } = this;
    renderer.setScissorTest(true);
    renderer.setScissor(0, 0, 1, 1);
    this.#renderOver(this.#materials.fading); // looks the same: what does not fade shows in all pixels
    renderer.setScissorTest(false);
    this.#pickAt(0.5, 0.5);
  }

  /** The patches again, over the picture. */
  #renderOver(material: Material): void {
    const { renderer } = this;
    const hidden = [this.#background.mesh, this.#spheres.lines];
    const were = hidden.map((object) => object.visible);
    for (const object of hidden) object.visible = false;
    renderer.autoClear = false;
    this.#scene.overrideMaterial = material;
    renderer.render(this.#scene, this.navigation.camera);
    this.#scene.overrideMaterial = null;
    hidden.forEach((object, i) => {
      object.visible = were[i]!;
    });
  }

  #note(interval: number): void {
    this.frameTimes.push(interval);
    if (this.frameTimes.length > FRAME_TIMES_KEPT) this.frameTimes.shift();
    this.motion.frame(interval, this.drawnTriangles, this.#last - this.#lastMoved < SETTLE_MS);
  }

  #rest(): void {
    this.#isIdle = true;
    for (const resolve of this.#waiting.splice(0)) resolve();
    if (this.moments.firstSettled === undefined) this.#warmUp();
    this.moments.firstSettled ??= performance.now();
  }

  /** Wheel: bring the pivot to the surface under the cursor, once a gesture. */
  #anchorAt(event: WheelEvent): void {
    const isSameGesture = event.timeStamp - this.#lastWheel < 250;
    this.#lastWheel = event.timeStamp;
    if (isSameGesture || this.isLost) return;
    this.anchor(event.clientX, event.clientY);
  }

  #lastWheel = Number.NEGATIVE_INFINITY;

  /** Bring the pivot's depth to that of the surface at this place of the page, if there is one. */
  anchor(clientX: number, clientY: number): void {
    const point = this.pick(clientX, clientY);
    if (!point) return;
    const { camera } = this.navigation;
    const depth = -point.applyMatrix4(camera.matrixWorldInverse).z;
    this.navigation.anchor(depth);
  }

  #resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    const width = Math.max(1, clientWidth);
    const height = Math.max(1, clientHeight);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, MAX_PIXEL_RATIO));
    this.renderer.setSize(width, height, false);
    this.navigation.camera.aspect = width / height;
    this.navigation.camera.updateProjectionMatrix();
    this.#background.aspect = width / height;
    this.invalidate();
  }

  /** The GPU is gone, and what was on it. Three prevents the default, so the browser may give it back. */
  #lose(): void {
    this.isLost = true;
    cancelAnimationFrame(this.#handle);
    this.#handle = 0;
    for (const layer of this.layers) layer.clear();
    this.#streamer?.forgetAll();
    this.options.onLost();
  }

  #restore(): void {
    this.isLost = false;
    this.options.onRestored();
    this.invalidate();
  }
}
