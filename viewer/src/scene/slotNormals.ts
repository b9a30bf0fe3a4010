/**
 * Normals of the vertices of slot buffers: those that were sent, or else weighted by the areas of their faces and
 * kept up by what changed.
 *
 * A vertex's sum is made anew, face by face in the order of the slots, where any of its faces changed or moved, and
 * only there: so what is kept up is, bit for bit, what would be computed from nothing, and nothing drifts.
 */
import type { SlotBuffers, SlotChanges } from "../format/wire";

/** Marks of a vertex while changes are taken in. */
export const DIRTY = 1;
const MOVED = 2;
const BORN = 4;

export class SlotNormals {
  /** Three numbers a vertex slot: unit, or zero where no face has it. */
  values = new Float32Array(0);
  /** What a vertex that was born begins with: the mean of those around it that were there before. */
  first = new Float32Array(0);
  /** `DIRTY` (and more) for the vertices with another normal, after `update`. */
  marks = new Uint8Array(0);

  /**
   * Bring the normals up to what the slots are now.
   *
   * @param oldFaces - The corners before the change, of as many slots as there were.
   */
  update(slots: SlotBuffers, oldFaces: Uint32Array, changes: SlotChanges): void {
    this.#grow(slots.vertexCount);
    const { marks } = this;
    marks.fill(changes.isFresh ? DIRTY : 0);
    if (slots.hasNormals) {
      for (const list of [changes.moved, changes.born]) for (const v of list) marks[v] = DIRTY;
      this.values.set(slots.starts.subarray(0, 3 * slots.vertexCount));
      return;
    }
    if (!changes.isFresh) this.#mark(slots, oldFaces, changes);
    for (const v of changes.born) normalise(this.first, 3 * v);
    this.#sum(slots);
  }

  #mark(slots: SlotBuffers, oldFaces: Uint32Array, { born, moved, faces }: SlotChanges): void {
    const { marks } = this;
    const now = slots.faces;
    for (const v of moved) marks[v]! = DIRTY | MOVED;
    for (const v of born) {
      marks[v]! = DIRTY | MOVED | BORN;
      zero(this.first, 3 * v);
    }
    for (const f of faces) {
      for (let i = 3 * f; i < 3 * f + 3; i++) {
        if (i < oldFaces.length) marks[oldFaces[i]!]! |= DIRTY;
        marks[now[i]!]! |= DIRTY;
      }
    }
    if (moved.length + born.length > 0) this.#spread(now, slots.faceCount);
  }

  /** Where a corner moved, all corners of the face have another normal; what was born learns from the others. */
  #spread(faces: Uint32Array, count: number): void {
    const { marks } = this;
    for (let i = 0; i < 3 * count; i += 3) {
      const a = faces[i]!;
      const b = faces[i + 1]!;
      const c = faces[i + 2]!;
      const all = marks[a]! | marks[b]! | marks[c]!;
      if ((all & MOVED) === 0 || a === b) continue;
      marks[a]! |= DIRTY;
      marks[b]! |= DIRTY;
      marks[c]! |= DIRTY;
      if ((all & BORN) === 0) continue;
      this.#teach(a, b, c);
      this.#teach(b, c, a);
      this.#teach(c, a, b);
    }
  }

  /** If `v` was born, add to what it begins with what its two neighbours had. */
  #teach(v: number, a: number, b: number): void {
    const { marks, first, values } = this;
    if ((marks[v]! & BORN) === 0) return;
    if ((marks[a]! & BORN) === 0) add(first, 3 * v, values[3 * a]!, values[3 * a + 1]!, values[3 * a + 2]!);
    if ((marks[b]! & BORN) === 0) add(first, 3 * v, values[3 * b]!, values[3 * b + 1]!, values[3 * b + 2]!);
  }

  /** Make the sums of dirty vertices anew. */
  #sum(slots: SlotBuffers): void {
    const { marks, values } = this;
    const { positions: p, faces, faceCount, vertexCount } = slots;
    for (let v = 0; v < vertexCount; v++) if (marks[v]) zero(values, 3 * v);
    for (let i = 0; i < 3 * faceCount; i += 3) {
      const a = faces[i]!;
      const b = faces[i + 1]!;
      const c = faces[i + 2]!;
      if ((marks[a]! | marks[b]! | marks[c]!) === 0 || a === b) continue;
      const ux = p[3 * b]! - p[3 * a]!;
      const uy = p[3 * b + 1]! - p[3 * a + 1]!;
      const uz = p[3 * b + 2]! - p[3 * a + 2]!;
      const vx = p[3 * c]! - p[3 * a]!;
      const vy = p[3 * c + 1]! - p[3 * a + 1]!;
      const vz = p[3 * c + 2]! - p[3 * a + 2]!;
      const nx = uy * vz - uz * vy;
      const ny = uz * vx - ux * vz;
      const nz = ux * vy - uy * vx;
      if (marks[a]) add(values, 3 * a, nx, ny, nz);
      if (marks[b]) add(values, 3 * b, nx, ny, nz);
      if (marks[c]) add(values, 3 * c, nx, ny, nz);
    }
    for (let v = 0; v < vertexCount; v++) if (marks[v]) normalise(values, 3 * v);
  }

  #grow(vertices: number): void {
    if (vertices <= this.marks.length) return;
    const room = Math.ceil(1.5 * vertices);
    const { values, first } = this;
    this.values = new Float32Array(3 * room);
    this.values.set(values);
    this.first = new Float32Array(3 * room);
    this.first.set(first);
    this.marks = new Uint8Array(room);
  }
}

/** By hand: to fill three numbers takes fifty nanoseconds. */
function zero(out: Float32Array, at: number): void {
  out[at] = 0;
  out[at + 1] = 0;
  out[at + 2] = 0;
}

function add(out: Float32Array, at: number, x: number, y: number, z: number): void {
  out[at]! += x;
  out[at + 1]! += y;
  out[at + 2]! += z;
}

/** Make unit; zero stays zero, and so does what is too small to have a direction. */
function normalise(out: Float32Array, at: number): void {
  const x = out[at]!;
  const y = out[at + 1]!;
  const z = out[at + 2]!;
  const length = Math.sqrt(x * x + y * y + z * z);
  const scale = length > 0 ? 1 / length : 0;
  out[at] = x * scale;
  out[at + 1] = y * scale;
  out[at + 2] = z * scale;
}
