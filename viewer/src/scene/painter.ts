/** Draws: the scene with its background, wires and spheres over it, and the depth under a pixel. */
import { type PerspectiveCamera, Scene, type Vector3, type WebGLRenderer } from "three";
import { Background } from "./background";
import { MAX_PIXEL_RATIO } from "./device";
import { Inset } from "./inset";
import type { Layer, Look, Pass } from "./layer";
import { MovingMap } from "./light/movingMap";
import type { SceneLight } from "./light/sceneLight";
import { lightBy } from "./light/shader";
import { makeMaterials, type PatchMaterials } from "./material";
import { Picker } from "./picking";
import { makeGraphics, waitUntilDrawn } from "./renderer";
import { SphereLines } from "./spheres";

export class Painter {
  readonly materials: PatchMaterials = makeMaterials();
  readonly layers: Layer[] = [];
  readonly inset = new Inset();
  /** Of the latest picture. */
  readonly drawn = { patches: 0, triangles: 0 };
  /** The processor draws. */
  readonly isSoftware: boolean;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #background = new Background();
  readonly #spheres = new SphereLines();
  readonly #picker: Picker;
  #light: SceneLight | undefined;
  #moving: { map: MovingMap; layers: readonly Layer[] } | undefined;
  #isWireframe = false;
  #areSpheresOn = false;
  #look: Look | undefined;

  /** @throws Problem if the browser has no WebGL2. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    const { renderer, isSoftware } = makeGraphics(canvas);
    this.#renderer = renderer;
    this.isSoftware = isSoftware;
    renderer.info.autoReset = false;
    this.#picker = new Picker(renderer);
    this.#scene.matrixWorldAutoUpdate = false;
    this.#scene.onBeforeRender = (_renderer, _scene, camera) => {
      for (const layer of this.layers) layer.follow(camera);
      this.#light?.follow(camera);
    };
    this.#scene.add(this.#background.mesh, this.#spheres.lines, this.inset.frustum);
  }

  /** What is on the GPU now, as three counts it. */
  get counts(): { geometries: number; textures: number; programs: number } {
    const { memory, programs } = this.#renderer.info;
    return { geometries: memory.geometries, textures: memory.textures, programs: programs?.length ?? 0 };
  }

  add(layer: Layer): void {
    if (this.#look) layer.dress(this.#look);
    this.layers.push(layer);
    this.#scene.add(layer.group);
  }

  /** What the light of a scene is made with. */
  get renderer(): WebGLRenderer {
    return this.#renderer;
  }

  /**
   * Have this light shine on all layers.
   *
   * @param moving - Layers that cast by an ordinary shadow map.
   */
  shine(light: SceneLight, moving: readonly Layer[]): void {
    this.#light = light;
    if (moving.length) this.#moving = { map: new MovingMap(this.#renderer, light, moving), layers: moving };
    light.onChange = () => this.#dressByLight(light);
  }

  #dressByLight(light: SceneLight): void {
    const { solid, fading, cast } = this.materials;
    lightBy(light, [solid, fading, cast]);
    for (const layer of this.layers) layer.lightBy(light);
  }

  set look(look: Look) {
    this.#look = look;
    for (const layer of this.layers) layer.dress(look);
    this.materials.uniforms.hasTint.value = look.arePatchesTinted;
    this.#isWireframe = look.isWireframe;
    this.materials.solid.polygonOffset = look.isWireframe;
    this.materials.fading.polygonOffset = look.isWireframe;
    this.#areSpheresOn = look.areSpheresOn;
    this.#spheres.lines.visible = look.areSpheresOn;
    this.#background.colours = look.background;
  }

  /** Fit the picture to the canvas; its width over its height. */
  resize(): number {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, MAX_PIXEL_RATIO));
    this.#renderer.setSize(width, height, false);
    this.#background.aspect = width / height;
    return width / height;
  }

  /** @param depth - How far ahead the camera looks, for the picture from elsewhere. */
  draw(camera: PerspectiveCamera, depth: number): void {
    if (this.#areSpheresOn) this.#spheres.update(this.layers.filter((layer) => layer.group.visible));
    this.#renderer.info.reset();
    this.#drawMoving(camera);
    this.#renderer.autoClear = true;
    this.#renderer.render(this.#scene, camera);
    this.drawn.patches = this.layers.reduce((sum, layer) => sum + layer.drawn.patches, 0);
    this.drawn.triangles = this.layers.reduce((sum, layer) => sum + layer.drawn.triangles, 0);
    if (this.#isWireframe) this.#drawOver(camera, "wires");
    if (this.inset.place) this.#drawInset(camera, depth);
  }

  /** Return when it is drawn. */
  wait(): void {
    waitUntilDrawn(this.#renderer);
  }

  /** Make what the first fade and the first pick would make: 180 ms a shader where the processor draws. */
  warmUp(camera: PerspectiveCamera): void {
    this.#renderer.setScissorTest(true);
    this.#renderer.setScissor(0, 0, 1, 1);
    this.#drawOver(camera, "warm-up"); // looks the same: what does not fade shows in all pixels
    this.#renderer.setScissorTest(false);
    this.pick(0.5, 0.5, camera);
  }

  /** The point at a share of the picture's width and height from its top left corner, or null. */
  pick(x: number, y: number, camera: PerspectiveCamera): Vector3 | null {
    return this.#withLayersOnly("depth", () => this.#picker.pick(x, y, this.#scene, camera));
  }

  /** The layers again, over the picture. */
  #drawOver(camera: PerspectiveCamera, pass: Pass): void {
    this.#withLayersOnly(pass, () => {
      this.#renderer.autoClear = false;
      this.#renderer.render(this.#scene, camera);
    });
  }

  /** What moves, as the light sees it. */
  #drawMoving(camera: PerspectiveCamera): void {
    const { map, layers } = this.#moving ?? {};
    if (!map || !layers || !this.#light?.isThere) return;
    const hidden = this.layers.filter((layer) => layer.group.visible && !layers.includes(layer));
    for (const { group } of hidden) group.visible = false;
    this.#withLayersOnly("cast", () => map.draw(this.#scene, camera));
    for (const { group } of hidden) group.visible = true;
  }

  /** The graphics are lost, and what was on them. */
  clear(): void {
    this.#light?.clear();
    this.#moving?.map.clear();
  }

  #withLayersOnly<T>(pass: Pass, work: () => T): T {
    for (const layer of this.layers) layer.wear(pass);
    this.#background.mesh.visible = false;
    this.#spheres.lines.visible = false;
    const result = work();
    this.#background.mesh.visible = true;
    this.#spheres.lines.visible = this.#areSpheresOn;
    for (const layer of this.layers) layer.wear("picture");
    return result;
  }

  /** The scene once more, in its corner, seen from elsewhere. */
  #drawInset(camera: PerspectiveCamera, depth: number): void {
    const { inset } = this;
    const { left, top, width, height } = inset.place!;
    inset.follow(camera, depth);
    const corner = [left, this.canvas.clientHeight - top - height, width, height] as const;
    const renderer = this.#renderer;
    renderer.setViewport(...corner);
    renderer.setScissor(...corner);
    renderer.setScissorTest(true);
    renderer.autoClear = false;
    renderer.clearDepth();
    for (const layer of this.layers) layer.wear("inset");
    inset.frustum.visible = true;
    this.#spheres.lines.visible = false;
    renderer.render(this.#scene, inset.camera);
    this.#spheres.lines.visible = this.#areSpheresOn;
    inset.frustum.visible = false;
    for (const layer of this.layers) layer.wear("picture");
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
  }
}
