/** One asset in the scene: its selection, its patches on the GPU, and what of them shows. */
import {
  BufferAttribute,
  BufferGeometry,
  type Camera,
  Group,
  type Material,
  Mesh,
  Sphere,
  Vector3,
} from "three";
import type { Triple } from "../format/graph";
import { Selection, type SelectOptions } from "../select/cut";
import type { View } from "../select/screenError";
import type { Asset } from "../stream/asset";
import type { PackedPatch } from "../stream/pack";
import { Fade } from "./fade";
import type { Frame } from "./frame";
import { GridPlace } from "./gridPlace";
import type { PatchMaterials } from "./material";

/** What a patch needs to be drawn; set into the shared uniforms just before. */
interface PatchLook {
  low: number;
  high: number;
  readonly tint: Vector3;
  /** Grid position that its vertices are relative to. */
  readonly centre: Triple;
}

export class Layer {
  readonly group = new Group();
  readonly selection: Selection;
  readonly fade: Fade;
  /** 1 for the nodes on the GPU. */
  readonly available: Uint8Array;
  readonly #meshes = new Map<number, Mesh[]>();
  readonly #place: GridPlace;
  readonly #normalSteps: number;
  readonly #hasNormals: boolean;
  readonly #hasColours: boolean;
  areColoursOn = true;
  drawnPatches = 0;
  drawnTriangles = 0;

  constructor(
    readonly name: string,
    readonly asset: Asset,
    /** Its number in the streamer. */
    readonly index: number,
    readonly frame: Frame,
    private readonly materials: PatchMaterials,
    fadeMilliseconds: number,
  ) {
    const { graph, info } = asset;
    this.#place = new GridPlace(info, frame);
    this.selection = new Selection(graph, asset.nodeBytes);
    this.fade = new Fade(graph.nodes, fadeMilliseconds);
    this.available = new Uint8Array(graph.nodes);
    this.group.name = name;
    this.group.matrixAutoUpdate = false;
    const normal = info.streams.find((stream) => stream.name === "normal");
    this.#hasNormals = normal !== undefined;
    this.#normalSteps = 2 ** ((normal?.bits ?? 10) - 1) - 1;
    this.#hasColours = info.streams.some((stream) => stream.name === "colour");
  }

  get hasColours(): boolean {
    return this.#hasColours;
  }

  /** Bytes of the file that hold data which is on the GPU or was. */
  get fileBytes(): number {
    return this.asset.container.size;
  }

  /** Put a node's patches on the GPU's list; three uploads them when they are first drawn. */
  addNode(node: number, patches: readonly PackedPatch[]): void {
    if (this.available[node]) return;
    const first = this.asset.graph.firstPatch[node]!;
    const meshes = patches.map((patch, i) => this.#makeMesh(patch, node, first + i));
    this.#meshes.set(node, meshes);
    if (meshes.length) this.group.add(...meshes);
    this.available[node] = 1;
  }

  /** Free a node's patches. */
  removeNode(node: number): void {
    for (const mesh of this.#meshes.get(node) ?? []) {
      this.group.remove(mesh);
      mesh.geometry.dispose();
    }
    this.#meshes.delete(node);
    this.available[node] = 0;
    this.fade.forget(node);
  }

  /** Free everything, e.g. when the GPU is lost. */
  clear(): void {
    for (const node of [...this.#meshes.keys()]) this.removeNode(node);
    this.fade.reset();
  }

  /** Choose the cut for this view. */
  select(view: View, options: Omit<SelectOptions, "available">): void {
    this.selection.select(view, { ...options, available: this.available });
  }

  /** Advance the cross-fade and say which patches show, and which nodes are in use. */
  show(elapsed: number, onUse: (node: number) => void): void {
    const { graph } = this.asset;
    const { phase } = this.fade;
    this.fade.advance(this.selection.expanded, elapsed);
    this.drawnPatches = 0;
    this.drawnTriangles = 0;
    for (const [node, meshes] of this.#meshes) {
      const high = phase[node]!;
      if (high > 0 || this.selection.expanded[node]) onUse(node);
      const first = graph.firstPatch[node]!;
      meshes.forEach((mesh, i) => {
        const finer = graph.finer[first + i]!;
        const low = finer >= 0 ? phase[finer]! : 0;
        mesh.visible = low < high;
        if (!mesh.visible) return;
        const look = mesh.userData as PatchLook;
        look.low = low;
        look.high = high;
        mesh.material = low === 0 && high === 1 ? this.materials.solid : this.materials.fading;
      });
    }
  }

  /** What comes next is seen by this camera. */
  follow(camera: Camera): void {
    this.#place.follow(camera);
  }

  #makeMesh(patch: PackedPatch, node: number, patchId: number): Mesh {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", gpuOnly(new BufferAttribute(patch.positions, 4)));
    if (patch.normals) geometry.setAttribute("octahedral", gpuOnly(new BufferAttribute(patch.normals, 2)));
    if (patch.colours) geometry.setAttribute("srgb", gpuOnly(new BufferAttribute(patch.colours, 4, true)));
    geometry.setIndex(new BufferAttribute(patch.indices, 1)); // stays: wireframes are made from it
    geometry.boundingSphere = new Sphere(new Vector3(), patch.radius);
    const mesh = new Mesh(geometry, this.materials.solid);
    // For culling and for the order of drawing; the shader goes by the layer's own matrix.
    mesh.matrixAutoUpdate = false;
    mesh.matrixWorldAutoUpdate = false;
    this.#place.matrixOf(patch.centre, mesh.matrix);
    mesh.matrixWorld.copy(mesh.matrix);
    const look: PatchLook = { low: 0, high: 1, tint: tintOf(patchId), centre: patch.centre };
    mesh.userData = look;
    mesh.name = `node ${node}, patch ${patchId}`;
    const triangles = patch.indices.length / 3;
    mesh.onBeforeRender = (_renderer, _scene, _camera, _geometry, material) => {
      this.#beforeDraw(look, material);
      this.drawnPatches++;
      this.drawnTriangles += triangles;
    };
    return mesh;
  }

  #beforeDraw(look: PatchLook, material: Material): void {
    const { uniforms } = this.materials;
    uniforms.toEye.value = this.#place.toEye;
    this.#place.offsetOf(look.centre, uniforms.offset.value);
    uniforms.band.value.set(look.low, look.high);
    uniforms.tint.value.copy(look.tint);
    uniforms.normalSteps.value = this.#normalSteps;
    uniforms.isFlat.value = !this.#hasNormals;
    uniforms.hasColours.value = this.#hasColours && this.areColoursOn;
    (material as Material & { uniformsNeedUpdate: boolean }).uniformsNeedUpdate = true;
  }
}

/** Once it is on the GPU, the copy in memory is let go; a lost context fetches again. */
function gpuOnly(attribute: BufferAttribute): BufferAttribute {
  attribute.onUpload(function (this: BufferAttribute) {
    (this as { array: unknown }).array = EMPTY;
  });
  return attribute;
}
const EMPTY = new Float32Array(0);

/** A light colour a patch, neighbours far apart in hue: multiples of the golden angle. */
function tintOf(patch: number): Vector3 {
  const hue = (patch * 0.61803398875) % 1;
  const wave = (shift: number): number => 0.68 + 0.24 * Math.cos(2 * Math.PI * (hue + shift));
  return new Vector3(wave(0), wave(1 / 3), wave(2 / 3));
}
