/**
 * Where vertices of slot buffers are drawn: new ones come from where they were born, moved ones from where they
 * were drawn, in 150 ms; normals with them.
 *
 * Each vertex has the moment that its blend began, and the vertex shader does the rest, so an update uploads what
 * changed once, and frames between updates upload nothing. (Mixed by the page, a turn of a degree a frame at 54,000
 * triangles has 12,000 of 27,000 vertices on their way: 0.5 ms and 0.6 MB more for every frame.) The blend is even in
 * time: with an ease in and out a vertex that each message moves anew, 60 times a second, would hardly leave.
 */
import type { SlotBuffers, SlotChanges } from "../format/wire";
import { SlotNormals } from "./slotNormals";

export const BLEND_SECONDS = 0.15;
/** Began so long ago that it is over. */
const LONG_AGO = -1e6;

export class SlotBlend {
  /** Three numbers a vertex: where it goes, and from where. */
  position = new Float32Array(0);
  from = new Float32Array(0);
  normal = new Float32Array(0);
  fromNormal = new Float32Array(0);
  /** Seconds on the layer's clock when the blend of a vertex began. */
  since = new Float32Array(0);
  readonly #normals = new SlotNormals();
  #end = LONG_AGO;

  /** The vertices of the last update that are to be uploaded: marks, not 0 for those. */
  get marks(): Uint8Array {
    return this.#normals.marks;
  }

  /** At this moment some vertices are still on their way. */
  isMoving(now: number): boolean {
    return now < this.#end;
  }

  /**
   * Take in what changed.
   *
   * @param oldFaces - The corners before the change.
   * @param now - Seconds on the layer's clock.
   * @returns Whether there are more vertices than there was room for: all arrays are others then.
   */
  update(slots: SlotBuffers, oldFaces: Uint32Array, changes: SlotChanges, now: number): boolean {
    const hasGrown = this.#grow(slots.vertexCount);
    this.#normals.update(slots, oldFaces, changes);
    const { marks, values } = this.#normals;
    const { position, from, normal, fromNormal, since } = this;
    if (slots.hasNormals) {
      for (let v = 0; v < slots.vertexCount; v++) {
        if (!marks[v]) continue;
        for (const out of [position, from]) copy3(slots.positions, out, 3 * v);
        for (const out of [normal, fromNormal]) copy3(values, out, 3 * v);
        since[v] = LONG_AGO;
      }
      return hasGrown;
    }
    for (let v = 0; v < slots.vertexCount; v++) {
      if (marks[v]) this.#begin(v, now);
    }
    for (const v of changes.born) this.#beginNew(v, slots.starts);
    for (let v = 0; v < slots.vertexCount; v++) {
      if (!marks[v]) continue;
      copy3(slots.positions, position, 3 * v);
      copy3(values, normal, 3 * v);
      since[v] = changes.isFresh ? LONG_AGO : now;
    }
    if (!changes.isFresh) this.#end = now + BLEND_SECONDS;
    return hasGrown;
  }

  /** Begin where and as the vertex is drawn now. */
  #begin(v: number, now: number): void {
    const share = Math.min(1, (now - this.since[v]!) / BLEND_SECONDS);
    for (let i = 3 * v; i < 3 * v + 3; i++) {
      this.from[i] = mix(this.from[i]!, this.position[i]!, share);
      this.fromNormal[i] = mix(this.fromNormal[i]!, this.normal[i]!, share);
    }
  }

  /** Begin where the vertex was born, lit as those around it were. */
  #beginNew(v: number, starts: Float32Array): void {
    const { first, values } = this.#normals;
    copy3(starts, this.from, 3 * v);
    const isKnown = first[3 * v] !== 0 || first[3 * v + 1] !== 0 || first[3 * v + 2] !== 0;
    copy3(isKnown ? first : values, this.fromNormal, 3 * v);
  }

  #grow(vertices: number): boolean {
    if (vertices <= this.since.length) return false;
    const room = Math.ceil(1.5 * vertices);
    const grown = (old: Float32Array, length: number): Float32Array<ArrayBuffer> => {
      const next = new Float32Array(length);
      next.set(old);
      return next;
    };
    this.position = grown(this.position, 3 * room);
    this.from = grown(this.from, 3 * room);
    this.normal = grown(this.normal, 3 * room);
    this.fromNormal = grown(this.fromNormal, 3 * room);
    this.since = grown(this.since, room).fill(LONG_AGO, this.since.length);
    return true;
  }
}

function mix(a: number, b: number, share: number): number {
  return a * (1 - share) + b * share;
}

function copy3(from: Float32Array, to: Float32Array, at: number): void {
  to[at] = from[at]!;
  to[at + 1] = from[at + 1]!;
  to[at + 2] = from[at + 2]!;
}
