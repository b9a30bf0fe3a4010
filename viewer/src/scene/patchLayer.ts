/** A layer of patches, chosen by view: its selection, its patches on the GPU, and what of them shows. */
import {
  BufferAttribute,
  BufferGeometry,
  type Camera,
  Group,
  type Material,
  Mesh,
  type PerspectiveCamera,
  Sphere,
  Vector3,
} from "three";
import type { Triple } from "../format/graph";
import { Selection } from "../select/cut";
import type { Asset } from "../stream/asset";
import type { PackedPatch } from "../stream/pack";
import type { NodeAt } from "../stream/streamer";
import { Fade } from "./fade";
import { type Frame, toFrame } from "./frame";
import { GridPlace } from "./gridPlace";
import type { Cost, Layer, Look, Pass } from "./layer";
import type { PatchMaterials } from "./material";
import { viewOf } from "./view";

/** What a patch needs to be drawn; set into the shared uniforms just before. */
interface PatchLook {
  low: number;
  high: number;
  readonly tint: Vector3;
  /** Grid position that its vertices are relative to. */
  readonly centre: Triple;
}

/** What a layer has from those who feed it. */
export interface Supply {
  readonly isSettled: boolean;
  /** Keep this node: the present picture draws it. */
  touch(at: NodeAt): void;
}

const FADE_MS = 150;

export class PatchLayer implements Layer {
  readonly group = new Group();
  readonly hasColours: boolean;
  readonly hasPatches = true;
  readonly drawn = { patches: 0, triangles: 0 };
  version = 0;
  #areColoursOn = true;
  readonly #selection: Selection;
  readonly #fade: Fade;
  /** 1 for the nodes on the GPU. */
  readonly #available: Uint8Array;
  readonly #meshes = new Map<number, Mesh[]>();
  readonly #place: GridPlace;
  readonly #normalSteps: number;
  readonly #hasNormals: boolean;

  constructor(
    readonly name: string,
    private readonly asset: Asset,
    /** Its number in the streamer. */
    private readonly index: number,
    private readonly frame: Frame,
    private readonly materials: PatchMaterials,
    private readonly supply: Supply,
  ) {
    const { graph, info, nodeBytes } = asset;
    this.#place = new GridPlace(info, frame);
    this.#selection = new Selection(graph, nodeBytes);
    this.#fade = new Fade(graph.nodes, FADE_MS);
    this.#available = new Uint8Array(graph.nodes);
    this.group.name = name;
    this.group.matrixAutoUpdate = false;
    const normal = info.streams.find((stream) => stream.name === "normal");
    this.#hasNormals = normal !== undefined;
    this.#normalSteps = 2 ** ((normal?.bits ?? 10) - 1) - 1;
    this.hasColours = info.streams.some((stream) => stream.name === "colour");
  }

  get fileBytes(): number {
    return this.asset.container.size;
  }

  /** The streamer counts for all layers of patches. */
  get receivedBytes(): number {
    return 0;
  }

  get isWholeFile(): boolean {
    return this.asset.source.whole !== null;
  }

  get errorPx(): number {
    return this.#selection.errorPx;
  }

  get isFading(): boolean {
    return this.#fade.isMoving;
  }

  get isSettled(): boolean {
    return this.supply.isSettled;
  }

  set isStill(isStill: boolean) {
    this.#fade.duration = isStill ? 0 : FADE_MS;
  }

  get isStill(): boolean {
    return this.#fade.duration === 0;
  }

  /** Put a node's patches on the GPU's list; three uploads them when they are first drawn. */
  addNode(node: number, patches: readonly PackedPatch[]): void {
    if (this.#available[node]) return;
    const first = this.asset.graph.firstPatch[node]!;
    const meshes = patches.map((patch, i) => this.#makeMesh(patch, node, first + i));
    this.#meshes.set(node, meshes);
    if (meshes.length) this.group.add(...meshes);
    this.version++;
    this.#available[node] = 1;
  }

  /** Free a node's patches. */
  removeNode(node: number): void {
    for (const mesh of this.#meshes.get(node) ?? []) {
      this.group.remove(mesh);
      mesh.geometry.dispose();
    }
    this.#meshes.delete(node);
    this.#available[node] = 0;
    this.#fade.forget(node);
  }

  /** Free everything, e.g. when the GPU is lost. */
  clear(): void {
    for (const node of [...this.#meshes.keys()]) this.removeNode(node);
    this.#fade.reset();
  }

  choose(camera: PerspectiveCamera, height: number, errorPx: number, allowed: Cost): Cost {
    this.#selection.select(viewOf(camera, height, this.frame, this.asset), {
      errorPx,
      triangleBudget: allowed.triangles,
      byteBudget: allowed.bytes,
      available: this.#available,
    });
    return { triangles: this.#selection.triangles, bytes: this.#selection.heldBytes };
  }

  /** Nodes of the chosen cut that are not there, most urgent first, and how wrong it looks without them. */
  wanted(): (NodeAt & { errorPx: number })[] {
    const { wanted, wantedCount } = this.#selection;
    const nodes = [...wanted.subarray(0, wantedCount)];
    return nodes.map((node) => ({ asset: this.index, node, errorPx: this.#selection.screenError(node) }));
  }

  show(elapsed: number): void {
    const { graph } = this.asset;
    const { expanded } = this.#selection;
    const { phase } = this.#fade;
    this.#fade.advance(expanded, elapsed);
    for (const [node, meshes] of this.#meshes) {
      const high = phase[node]!;
      if (high > 0 || expanded[node]) this.supply.touch({ asset: this.index, node });
      const first = graph.firstPatch[node]!;
      meshes.forEach((mesh, i) => {
        const finer = graph.finer[first + i]!;
        const low = finer >= 0 ? phase[finer]! : 0;
        if (mesh.visible !== low < high) this.version++;
        mesh.visible = low < high;
        if (!mesh.visible) return;
        const look = mesh.userData as PatchLook;
        look.low = low;
        look.high = high;
        mesh.material = this.#materialOf(look);
      });
    }
  }

  /** The materials are those of all layers of patches. */
  lightBy(): void {}

  dress({ areColoursOn }: Look): void {
    this.#areColoursOn = areColoursOn;
  }

  wear(pass: Pass): void {
    const { wire, depth, cast, fading } = this.materials;
    const one = { wires: wire, depth, cast, "warm-up": fading, picture: null, inset: null }[pass];
    for (const mesh of this.group.children as Mesh[]) {
      if (mesh.visible) mesh.material = one ?? this.#materialOf(mesh.userData as PatchLook);
    }
  }

  #materialOf({ low, high }: PatchLook): Material {
    return low === 0 && high === 1 ? this.materials.solid : this.materials.fading;
  }

  follow(camera: Camera): void {
    this.drawn.patches = 0;
    this.drawn.triangles = 0;
    this.#place.follow(camera);
    this.materials.uniforms.far.value = (camera as PerspectiveCamera).far;
  }

  forEachSphere(visit: (centre: Triple, radius: number) => void): void {
    const { graph, info } = this.asset;
    const { origin } = info;
    for (let node = 0; node < graph.nodes; node++) {
      if (!this.#isLeaf(node)) continue;
      const [x, y, z, radius] = graph.spheres.subarray(4 * node, 4 * node + 4);
      const centre = toFrame(this.frame, [x! + origin[0], y! + origin[1], z! + origin[2]]);
      visit(centre, radius! * this.frame.scale);
    }
  }

  /** Whether the node is in the cut and nothing finer takes the place of any of its patches. */
  #isLeaf(node: number): boolean {
    const { firstPatch, finer } = this.asset.graph;
    const { expanded } = this.#selection;
    if (!expanded[node]) return false;
    for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) {
      if (finer[patch]! >= 0 && expanded[finer[patch]!]) return false;
    }
    return true;
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
      this.drawn.patches++;
      this.drawn.triangles += triangles;
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
    uniforms.hasColours.value = this.hasColours && this.#areColoursOn;
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
