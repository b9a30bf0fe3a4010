/**
 * The flat arrays of a √3 refinement, and their packed words by name.
 *
 * - A face has three corners, counter-clockwise, the faces beyond its three edges (`beside[k]` beyond the edge from
 *   corner k to k + 1), and a state. A face of generation k is a triangle of uniform subdivision's level k. A half of
 *   generation k is a third of a split face whose old edge, its edge 0, could not be flipped yet, since the face
 *   beyond is not split; its corner 2 is the new vertex.
 * - A vertex has three vectors, `born`, `limit` and `third`, which say where it is on every level (`points.ts`); the
 *   corners of the face in which it was born; the other vertex born in the same border edge; one of its faces.
 * - A seam is a sharp edge, along which the mesh is cut open: each side has vertices of its own, and the rules of a
 *   border. `beside` is negative at both: NONE at a border, at a seam which edge of which face is beyond.
 * - Slots are reused, so that what did not change stays where it is. No edges, no hierarchy.
 *
 * The same as `src/foveal/refine/net.py` and `_kernels_sqrt3_layout.py`, one array a field: a typed array has no
 * records. spec/refinement.md tells what both sides promise.
 *
 * @module refine/net
 */

export const NONE = -1;

/** State of a face slot, birth of a vertex slot, that is not in use. */
export const FREE = -1;

/** Kinds of vertices. */
export const INSIDE = 0;
export const LATE = 1;
export const BORDER = 2;
export const UNMEASURED = 3;
export const CORNER = 4;

/**
 * Flags of vertices: its birth face is to be split for itself; for finer ones; it meets the criteria; and which
 * corners of the birth face are its parents, `PARENT << k`: those born with it.
 */
export const WANTED = 1;
export const NEEDED = 2;
export const MEETS = 4;
export const PARENT = 8;
export const PARENTS = 56;

/** Iterations at most: 3^30 triangles for one are far more than a double can tell apart. */
export const MAX_LEVEL = 30;

/** Numbers of a vertex in `points`: born, limit, third. */
export const POINT = 9;
export const LIMIT = 3;
export const THIRD_VECTOR = 6;

/** What is beside a face at a seam beyond which is edge k of face f. */
export function seam(f: number, k: number): number {
  return -2 - (3 * f + k);
}

/** The half-edge beyond a seam, 3 f + k. */
export function beyondSeam(word: number): number {
  return -2 - word;
}

/** State of a face of a generation; of a half one more. Shifted back it is the generation. */
export function whole(level: number): number {
  return 2 * level;
}

export function half(level: number): number {
  return 2 * level + 1;
}

export function generation(state: number): number {
  return state >> 1;
}

export function isHalf(state: number): boolean {
  return (state & 1) === 1;
}

export class Net {
  corners: Int32Array;
  /** Of a free slot the first is the next free one. */
  beside: Int32Array;
  /** Up to which drift of the view a face is known not to be wanted split. */
  faceUntil: Float32Array;
  states: Int8Array;
  isQueued: Uint8Array;
  points: Float64Array;
  /** Of a free slot the first is the next free one. */
  triples: Int32Array;
  pairs: Int32Array;
  /** The vertex at the same place beyond a seam, or NONE. */
  twins: Int32Array;
  around: Int32Array;
  /** Up to which drift it is known whether a vertex's birth face meets the criteria. */
  vertexUntil: Float32Array;
  kinds: Uint8Array;
  births: Int8Array;
  flags: Uint8Array;
  /** Of the limit surface; 32 bits, as everywhere. */
  normals: Float32Array;
  /** Of the control mesh's vertices: how much nearer to their limit they come with each level. */
  readonly shrinks: Float64Array;
  /** A ring of faces that have to be asked whether they are wanted split. */
  queue: Int32Array;

  /** Slots ever used, how many of them are free, the first free ones; the queue's first place and length. */
  faceSlots = 0;
  vertexSlots = 0;
  freeFaces = 0;
  freeVertices = 0;
  freeFace = 0;
  freeVertex = 0;
  first = 0;
  queued = 0;

  /** Room for so many faces and vertices, of a control mesh with `base` vertices. */
  constructor(faces: number, vertices: number, base: number) {
    this.corners = new Int32Array(3 * faces);
    this.beside = new Int32Array(3 * faces);
    this.faceUntil = new Float32Array(faces);
    this.states = new Int8Array(faces);
    this.isQueued = new Uint8Array(faces);
    this.points = new Float64Array(POINT * vertices);
    this.triples = new Int32Array(3 * vertices);
    this.pairs = new Int32Array(vertices);
    this.twins = new Int32Array(vertices);
    this.around = new Int32Array(vertices);
    this.vertexUntil = new Float32Array(vertices);
    this.kinds = new Uint8Array(vertices);
    this.births = new Int8Array(vertices);
    this.flags = new Uint8Array(vertices);
    this.normals = new Float32Array(3 * vertices);
    this.shrinks = new Float64Array(base);
    this.queue = new Int32Array(faces);
  }

  /** Faces and halves in use. */
  get faces(): number {
    return this.faceSlots - this.freeFaces;
  }

  /** Vertices in use. */
  get vertices(): number {
    return this.vertexSlots - this.freeVertices;
  }

  /** Twice the room; the queue begins at its array's beginning. */
  grow(): void {
    const faces = 2 * this.states.length;
    const vertices = 2 * this.births.length;
    this.corners = copied(this.corners, new Int32Array(3 * faces));
    this.beside = copied(this.beside, new Int32Array(3 * faces));
    this.faceUntil = copied(this.faceUntil, new Float32Array(faces));
    this.states = copied(this.states, new Int8Array(faces));
    this.isQueued = copied(this.isQueued, new Uint8Array(faces));
    this.points = copied(this.points, new Float64Array(POINT * vertices));
    this.triples = copied(this.triples, new Int32Array(3 * vertices));
    this.pairs = copied(this.pairs, new Int32Array(vertices));
    this.twins = copied(this.twins, new Int32Array(vertices));
    this.around = copied(this.around, new Int32Array(vertices));
    this.vertexUntil = copied(this.vertexUntil, new Float32Array(vertices));
    this.kinds = copied(this.kinds, new Uint8Array(vertices));
    this.births = copied(this.births, new Int8Array(vertices));
    this.flags = copied(this.flags, new Uint8Array(vertices));
    this.normals = copied(this.normals, new Float32Array(3 * vertices));
    const queue = new Int32Array(faces);
    queue.set(this.queue.subarray(this.first));
    queue.set(this.queue.subarray(0, this.first), this.queue.length - this.first);
    this.queue = queue;
    this.first = 0;
  }
}

function copied<T extends { set(from: T): void }>(from: T, to: T): T {
  to.set(from);
  return to;
}
