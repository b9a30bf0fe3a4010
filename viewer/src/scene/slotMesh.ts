/**
 * Slot buffers on the GPU: one indexed mesh, its edges as lines, and its faces by level or colour.
 *
 * Each update uploads what changed. A free slot is a triangle without area, so nothing is moved together. What a
 * face is (its tag) cannot be told to an indexed mesh in WebGL2, so for that there is a second one, of three corners
 * a face, made when it is first asked for and without blending.
 */
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineSegments, Mesh } from "three";
import type { SlotBuffers, SlotChanges } from "../format/wire";
import type { RefinedMaterials } from "./refinedMaterial";
import { SlotBlend } from "./slotBlend";

/** Slots between two changed ones that cost less to upload again than a call of its own: half a microsecond. */
const GAP = 64;

export class SlotMesh {
  readonly surface: Mesh;
  readonly wires: LineSegments;
  readonly tagged: Mesh;
  readonly #blend = new SlotBlend();
  /** Corners as the GPU has them, with room for more. */
  #corners = new Uint32Array(0);
  #edges = new Uint32Array(0);
  #faceCount = 0;
  #hasWires = false;
  #hasTags = false;

  constructor(
    private readonly slots: SlotBuffers,
    materials: RefinedMaterials,
  ) {
    this.surface = new Mesh(new BufferGeometry(), materials.surface);
    this.wires = new LineSegments(new BufferGeometry(), materials.wire);
    this.tagged = new Mesh(new BufferGeometry(), materials.tagged);
    for (const mesh of [this.surface, this.wires, this.tagged]) {
      mesh.frustumCulled = false; // most of what is refined is in view
      mesh.matrixAutoUpdate = false;
      mesh.matrixWorldAutoUpdate = false;
    }
  }

  isMoving(now: number): boolean {
    return this.#blend.isMoving(now);
  }

  /** Of GPU memory. */
  get bytes(): number {
    const all = [this.surface, this.wires, this.tagged].flatMap(({ geometry }) => [
      ...Object.values(geometry.attributes),
      ...(geometry.index ? [geometry.index] : []),
    ]);
    return [...new Set(all)].reduce((sum, attribute) => sum + attribute.array.byteLength, 0);
  }

  /** Make lines and tagged faces, or keep them no longer. */
  show(hasWires: boolean, hasTags: boolean): void {
    if (hasWires !== this.#hasWires) {
      this.#hasWires = hasWires;
      this.#makeWires();
    }
    if (hasTags !== this.#hasTags) {
      this.#hasTags = hasTags;
      this.#makeTagged();
    }
  }

  /** Take in what changed in the slots. */
  update(changes: SlotChanges, now: number): void {
    const { slots } = this;
    const oldFaces = this.#corners.subarray(0, 3 * this.#faceCount);
    const hasMoreVertices = this.#blend.update(slots, oldFaces, changes, now);
    const hasMoreFaces = 3 * slots.faceCount > this.#corners.length;
    if (hasMoreFaces) this.#corners = grown(this.#corners, 3 * Math.ceil(1.5 * slots.faceCount));
    this.#faceCount = slots.faceCount;
    if (changes.isFresh) this.#corners.fill(0).set(slots.faces.subarray(0, 3 * slots.faceCount));
    else for (const f of changes.faces) copyFace(slots.faces, this.#corners, f);
    const { srgb } = this.surface.geometry.attributes;
    const areOtherColours = srgb?.array !== (slots.hasColours ? slots.colours : undefined);
    if (hasMoreVertices || hasMoreFaces || areOtherColours) this.renew();
    else this.#upload(changes);
    this.surface.geometry.setDrawRange(0, 3 * slots.faceCount);
    this.wires.geometry.setDrawRange(0, 6 * slots.faceCount);
    this.tagged.geometry.setDrawRange(0, 3 * slots.faceCount);
  }

  /** New buffers for the GPU: there are more slots, or the old ones are lost. */
  renew(): void {
    const { position, from, normal, fromNormal, since } = this.#blend;
    this.surface.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", dynamic(position, 3));
    geometry.setAttribute("from", dynamic(from, 3));
    geometry.setAttribute("normal", dynamic(normal, 3));
    geometry.setAttribute("fromNormal", dynamic(fromNormal, 3));
    geometry.setAttribute("since", dynamic(since, 1));
    if (this.slots.hasColours) geometry.setAttribute("srgb", dynamic(this.slots.colours, 4, true));
    geometry.setIndex(dynamic(this.#corners, 1));
    geometry.setDrawRange(0, 3 * this.#faceCount);
    this.surface.geometry = geometry;
    this.#makeWires();
    this.#makeTagged();
  }

  /** Lines have the surface's vertices and an index of their own. */
  #makeWires(): void {
    this.wires.geometry.dispose();
    const geometry = new BufferGeometry();
    this.wires.geometry = geometry;
    if (!this.#hasWires) return;
    Object.assign(geometry.attributes, this.surface.geometry.attributes);
    this.#edges = new Uint32Array(2 * this.#corners.length);
    for (let f = 0; f < this.#faceCount; f++) writeEdges(this.#corners, this.#edges, f);
    geometry.setIndex(dynamic(this.#edges, 1));
    geometry.setDrawRange(0, 6 * this.#faceCount);
  }

  #makeTagged(): void {
    this.tagged.geometry.dispose();
    const geometry = new BufferGeometry();
    this.tagged.geometry = geometry;
    if (!this.#hasTags) return;
    const corners = this.#corners.length;
    geometry.setAttribute("position", dynamic(new Float32Array(3 * corners), 3));
    geometry.setAttribute("tag", dynamic(new Uint8Array(corners), 1));
    this.#writeTagged([[0, this.#faceCount]]);
    geometry.setDrawRange(0, 3 * this.#faceCount);
  }

  #upload(changes: SlotChanges): void {
    const { surface, wires } = this;
    const all = changes.isFresh;
    const vertices = all
      ? wholeRun(this.slots.vertexCount)
      : runsOf(this.#blend.marks, this.slots.vertexCount);
    for (const attribute of Object.values(surface.geometry.attributes)) {
      touch(attribute as BufferAttribute, vertices, attribute.itemSize);
    }
    const faces = all ? wholeRun(this.#faceCount) : runsOfList(changes.faces);
    touch(surface.geometry.index!, faces, 3);
    if (this.#hasWires) {
      forEachIn(faces, (f) => writeEdges(this.#corners, this.#edges, f));
      touch(wires.geometry.index!, faces, 6);
    }
    if (this.#hasTags) this.#uploadTagged(changes);
  }

  /** Faces that changed, and those with a corner that did. */
  #uploadTagged({ isFresh, faces }: SlotChanges): void {
    const { marks } = this.#blend;
    const corners = this.#corners;
    const isChanged = new Uint8Array(this.#faceCount);
    for (const f of faces) isChanged[f] = 1;
    for (let f = 0, i = 0; f < this.#faceCount; f++, i += 3) {
      if (isFresh || marks[corners[i]!]! | marks[corners[i + 1]!]! | marks[corners[i + 2]!]!)
        isChanged[f] = 1;
    }
    const runs = runsOf(isChanged, this.#faceCount);
    this.#writeTagged(runs);
    const { position, tag } = this.tagged.geometry.attributes;
    touch(position as BufferAttribute, runs, 9);
    touch(tag as BufferAttribute, runs, 3);
  }

  /** Give these faces three corners of their own. */
  #writeTagged(runs: readonly Run[]): void {
    const { position, tag } = this.tagged.geometry.attributes;
    const places = position!.array as Float32Array;
    const tags = tag!.array as Uint8Array;
    const corners = this.#corners;
    const from = this.#blend.position;
    for (const [begin, end] of runs) {
      for (let i = 3 * begin; i < 3 * end; i++) {
        const v = 3 * corners[i]!;
        places[3 * i] = from[v]!;
        places[3 * i + 1] = from[v + 1]!;
        places[3 * i + 2] = from[v + 2]!;
      }
      for (let f = begin; f < end; f++) tags[3 * f] = tags[3 * f + 1] = tags[3 * f + 2] = this.slots.tags[f]!;
    }
  }
}

/** First slot and the one after the last. */
export type Run = readonly [begin: number, end: number];

/** Runs of marked slots, over gaps that are not worth a call. */
export function runsOf(marks: Uint8Array, count: number): Run[] {
  const runs: [number, number][] = [];
  for (let i = 0; i < count; i++) if (marks[i]) extend(runs, i);
  return runs;
}

function runsOfList(list: Uint32Array): Run[] {
  const runs: [number, number][] = [];
  for (const i of list) extend(runs, i);
  return runs;
}

function extend(runs: [number, number][], i: number): void {
  const last = runs.at(-1);
  if (last && i - last[1] < GAP) last[1] = i + 1;
  else runs.push([i, i + 1]);
}

function wholeRun(count: number): Run[] {
  return count ? [[0, count]] : [];
}

function forEachIn(runs: readonly Run[], visit: (slot: number) => void): void {
  for (const [begin, end] of runs) for (let i = begin; i < end; i++) visit(i);
}

/** Have these slots uploaded before the next drawing. */
function touch(attribute: BufferAttribute, runs: readonly Run[], perSlot: number): void {
  if (runs.length === 0) return;
  for (const [begin, end] of runs) attribute.addUpdateRange(perSlot * begin, perSlot * (end - begin));
  attribute.needsUpdate = true;
}

function dynamic(
  array: Float32Array | Uint32Array | Uint8Array,
  itemSize: number,
  isNormalised = false,
): BufferAttribute {
  return new BufferAttribute(array, itemSize, isNormalised).setUsage(DynamicDrawUsage);
}

function grown(old: Uint32Array, length: number): Uint32Array<ArrayBuffer> {
  const next = new Uint32Array(length);
  next.set(old);
  return next;
}

function copyFace(from: Uint32Array, to: Uint32Array, f: number): void {
  for (let i = 3 * f; i < 3 * f + 3; i++) to[i] = from[i]!;
}

/** The three edges of a face, as pairs. */
function writeEdges(corners: Uint32Array, out: Uint32Array, f: number): void {
  for (let k = 0; k < 3; k++) {
    out[6 * f + 2 * k] = corners[3 * f + k]!;
    out[6 * f + 2 * k + 1] = corners[3 * f + ((k + 1) % 3)]!;
  }
}
