/** Draws: the scene with its background, wires and spheres over it, and the depth under a pixel. */
import { type Material, type PerspectiveCamera, Scene, type Vector3, type WebGLRenderer } from "three";
import { Background, type BackgroundColours } from "./background";
import { MAX_PIXEL_RATIO } from "./device";
import type { Layer } from "./layer";
import { makeMaterials, type PatchMaterials } from "./material";
import { Picker } from "./picking";
import { makeGraphics, waitUntilDrawn } from "./renderer";
import { SphereLines } from "./spheres";

/** How it is drawn, whatever is drawn. */
export interface Look {
  readonly areColoursOn: boolean;
  readonly arePatchesTinted: boolean;
  readonly isWireframe: boolean;
  readonly areSpheresOn: boolean;
  readonly background: BackgroundColours;
}

export class Painter {
  readonly materials: PatchMaterials = makeMaterials();
  readonly layers: Layer[] = [];
  /** Of the latest picture. */
  readonly drawn = { patches: 0, triangles: 0 };
  /** The processor draws. */
  readonly isSoftware: boolean;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #background = new Background();
  readonly #spheres = new SphereLines();
  readonly #picker: Picker;
  #isWireframe = false;
  #areSpheresOn = false;
  #areColoursOn = true;

  /** @throws Problem if the browser has no WebGL2. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    const { renderer, isSoftware } = makeGraphics(canvas);
    this.#renderer = renderer;
    this.isSoftware = isSoftware;
    renderer.info.autoReset = false;
    this.#picker = new Picker(renderer, this.materials);
    this.#scene.matrixWorldAutoUpdate = false;
    this.#scene.onBeforeRender = (_renderer, _scene, camera) => {
      for (const layer of this.layers) layer.follow(camera);
    };
    this.#scene.add(this.#background.mesh, this.#spheres.lines);
  }

  /** What is on the GPU now, as three counts it. */
  get counts(): { geometries: number; textures: number; programs: number } {
    const { memory, programs } = this.#renderer.info;
    return { geometries: memory.geometries, textures: memory.textures, programs: programs?.length ?? 0 };
  }

  add(layer: Layer): void {
    layer.areColoursOn = this.#areColoursOn;
    this.layers.push(layer);
    this.#scene.add(layer.group);
  }

  set look(look: Look) {
    this.#areColoursOn = look.areColoursOn;
    for (const layer of this.layers) layer.areColoursOn = look.areColoursOn;
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

  draw(camera: PerspectiveCamera): void {
    if (this.#areSpheresOn) this.#spheres.update(this.layers.filter((layer) => layer.group.visible));
    this.#renderer.info.reset();
    this.#renderer.autoClear = true;
    this.#renderer.render(this.#scene, camera);
    this.drawn.patches = this.layers.reduce((sum, layer) => sum + layer.drawn.patches, 0);
    this.drawn.triangles = this.layers.reduce((sum, layer) => sum + layer.drawn.triangles, 0);
    if (this.#isWireframe) this.#drawOver(camera, this.materials.wire);
  }

  /** Return when it is drawn. */
  wait(): void {
    waitUntilDrawn(this.#renderer);
  }

  /** Make what the first fade and the first pick would make: 180 ms a shader where the processor draws. */
  warmUp(camera: PerspectiveCamera): void {
    this.#renderer.setScissorTest(true);
    this.#renderer.setScissor(0, 0, 1, 1);
    this.#drawOver(camera, this.materials.fading); // looks the same: what does not fade shows in all pixels
    this.#renderer.setScissorTest(false);
    this.pick(0.5, 0.5, camera);
  }

  /** The point at a share of the picture's width and height from its top left corner, or null. */
  pick(x: number, y: number, camera: PerspectiveCamera): Vector3 | null {
    return this.#withLayersOnly(() => this.#picker.pick(x, y, this.#scene, camera));
  }

  /** The layers again, over the picture. */
  #drawOver(camera: PerspectiveCamera, material: Material): void {
    this.#withLayersOnly(() => {
      this.#renderer.autoClear = false;
      this.#scene.overrideMaterial = material;
      this.#renderer.render(this.#scene, camera);
      this.#scene.overrideMaterial = null;
    });
  }

  #withLayersOnly<T>(work: () => T): T {
    this.#background.mesh.visible = false;
    this.#spheres.lines.visible = false;
    const result = work();
    this.#background.mesh.visible = true;
    this.#spheres.lines.visible = this.#areSpheresOn;
    return result;
  }
}
