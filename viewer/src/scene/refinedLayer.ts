/** A layer that is refined for the camera by somebody else: it says what it wants, and draws the slots it is given. */
import { type Camera, Group, type Material, type PerspectiveCamera } from "three";
import { CATMULL_CLARK, type Refinement } from "../format/cage";
import type { Triple } from "../format/graph";
import type { Problem } from "../format/problem";
import type { RefinementFigures, RefinementSource } from "../stream/refinement";
import type { Box, Frame } from "./frame";
import type { Cost, FaceColours, Layer, Look, Pass } from "./layer";
import { type LightShader, lightBy } from "./light/shader";
import { makeRefinedMaterials } from "./refinedMaterial";
import { RefinedPlace } from "./refinedPlace";
import { SlotMesh } from "./slotMesh";

export interface RefinedAsset {
  readonly name: string;
  /** What positions are relative to, in the asset's unit. */
  readonly origin: Triple;
  readonly box: Box;
  readonly fileBytes: number;
  readonly source: RefinementSource;
  /** What is wanted at first. */
  readonly refinement: Refinement;
}

export interface RefinedOptions {
  /** The picture is another now. */
  readonly onChange: () => void;
  /** Something is wrong, or (null) all is well again. */
  readonly onProblem: (problem: Problem | null) => void;
  /** Milliseconds that the last picture took. */
  readonly drawnMs: () => number;
}

/** Strength of the edges in the picture from elsewhere, and of those that were asked for. */
const INSET_LINE = 0.55;
const WIRE_LINE = 0.7;

export class RefinedLayer implements Layer {
  readonly name: string;
  readonly group = new Group();
  readonly hasPatches = false;
  readonly isWholeFile = false;
  readonly errorPx = 0;
  readonly drawn = { patches: 0, triangles: 0 };
  isStill = false;
  version = 0;
  /** What is wanted now. */
  wants: Refinement;
  readonly #materials = makeRefinedMaterials();
  readonly #place: RefinedPlace;
  readonly #mesh: SlotMesh;
  /** Seconds that pictures have moved things on. */
  #clock = 0;
  #faceColours: FaceColours = "plain";
  #areColoursOn = true;
  #isWireframe = false;
  /** The last picture had one from elsewhere in it, which needs the faces apart. */
  #hadInset = false;

  constructor(
    private readonly asset: RefinedAsset,
    frame: Frame,
    private readonly options: RefinedOptions,
  ) {
    this.name = asset.name;
    this.wants = asset.refinement;
    this.#place = new RefinedPlace(asset.origin, asset.box, frame);
    this.#mesh = new SlotMesh(asset.source.slots, this.#materials);
    const { surface, wires, tagged } = this.#mesh;
    this.group.name = asset.name;
    this.group.matrixAutoUpdate = false;
    this.group.add(surface, wires, tagged);
    for (const mesh of [surface, wires, tagged]) {
      mesh.onBeforeRender = (_renderer, _scene, _camera, _geometry, material) => this.#beforeDraw(material);
    }
    asset.source.listen({
      onChange: (changes) => {
        this.#mesh.update(changes, this.#clock);
        this.version++;
        options.onChange();
      },
      onProblem: (problem) => {
        options.onProblem(problem);
        options.onChange();
      },
    });
  }

  /** Known from the first message on. */
  get hasColours(): boolean {
    return this.asset.source.slots.hasColours;
  }

  get figures(): RefinementFigures {
    return this.asset.source.figures;
  }

  get fileBytes(): number {
    return this.asset.fileBytes;
  }

  get receivedBytes(): number {
    return this.figures.receivedBytes;
  }

  get isFading(): boolean {
    return !this.isStill && this.#mesh.isMoving(this.#clock);
  }

  get isSettled(): boolean {
    return !this.group.visible || this.asset.source.isSettled;
  }

  retry(): void {
    this.asset.source.retry();
  }

  choose(camera: PerspectiveCamera, height: number, _errorPx: number, allowed: Cost): Cost {
    const { scheme, criteria, depths, positions, budget, rate } = this.wants;
    this.asset.source.request(
      {
        camera: this.#place.cameraOf(camera, height),
        criteria,
        ...(scheme === CATMULL_CLARK ? { depths } : {}),
        budget: Math.max(1, Math.floor(Math.min(budget || Infinity, allowed.triangles))),
        positions,
        rate,
      },
      this.options.drawnMs(),
    );
    return { triangles: this.figures.triangles, bytes: this.#mesh.bytes };
  }

  show(elapsed: number): void {
    if (this.isFading) this.version++;
    this.#clock += elapsed / 1000;
    const { uniforms } = this.#materials;
    uniforms.now.value = this.#clock;
    uniforms.isStill.value = this.isStill;
    uniforms.hasColours.value = this.hasColours && this.#areColoursOn;
    this.#prepare(this.#hadInset);
    this.#hadInset = false;
    this.wear("picture");
  }

  dress({ faceColours, isWireframe, areColoursOn }: Look): void {
    this.#areColoursOn = areColoursOn;
    this.#faceColours = faceColours;
    this.#isWireframe = isWireframe;
    this.#materials.surface.polygonOffset = isWireframe;
  }

  lightBy(light: LightShader): void {
    const { surface, tagged, cast } = this.#materials;
    lightBy(light, [surface, tagged, cast]);
  }

  #prepare(hasInset: boolean): void {
    const areTagged = this.#faceColours !== "plain";
    this.#mesh.show(this.#isWireframe && !areTagged, areTagged || hasInset);
  }

  wear(pass: Pass): void {
    if (pass === "inset") {
      this.#hadInset = true;
      this.#prepare(true);
    }
    const { surface, wires, tagged } = this.#mesh;
    const { uniforms, surface: plain, depth, cast } = this.#materials;
    const isPicture = pass === "picture" || pass === "warm-up";
    tagged.visible = pass === "inset" || (isPicture && this.#faceColours !== "plain");
    wires.visible = pass === "wires" && this.#faceColours === "plain";
    const isUnseen = pass === "depth" || pass === "cast";
    surface.visible = isUnseen || (isPicture && !tagged.visible);
    surface.material = pass === "depth" ? depth : pass === "cast" ? cast : plain;
    uniforms.areLevels.value = this.#faceColours !== "triplet";
    uniforms.line.value = pass === "inset" ? INSET_LINE : this.#isWireframe ? WIRE_LINE : 0;
  }

  follow(camera: Camera): void {
    this.drawn.patches = 0;
    this.drawn.triangles = 0;
    this.#place.follow(camera);
    const { uniforms } = this.#materials;
    uniforms.reference.value.copy(this.#place.reference);
    uniforms.toEye.value.copy(this.#place.toEye);
    uniforms.far.value = (camera as PerspectiveCamera).far;
  }

  /** There are no parts that could have any. */
  forEachSphere(): void {}

  /** All arrays are kept, and go up again. */
  clear(): void {
    this.#mesh.renew();
  }

  #beforeDraw(material: Material): void {
    (material as Material & { uniformsNeedUpdate: boolean }).uniformsNeedUpdate = true;
    this.drawn.patches = Math.min(1, this.figures.triangles);
    this.drawn.triangles = this.figures.triangles;
  }
}
