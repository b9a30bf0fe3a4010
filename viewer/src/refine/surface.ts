/**
 * The control mesh of a refinement: an oriented surface, with its neighbours, rings and border, cut open along sharp
 * edges.
 *
 * The same as `src/foveal/refine/cage.py`. What is no surface is refused with a sentence: foveal writes no such
 * file, but a page takes files from anywhere.
 *
 * @module refine/surface
 */
import { Problem } from "../format/problem";
import { NONE, seam } from "./net";
import { cornerAt } from "./slots";

/** A triangle mesh as a `.fov` of kind `cage` has it. */
export interface ControlMesh {
  /** Three doubles a vertex, finite, in the asset's unit. */
  readonly positions: Float64Array;
  /** Three vertices a face, each below the number of vertices; counter-clockwise. */
  readonly faces: Int32Array;
  /** Two vertices each of the edges that stay sharp, if there are any; one on the border changes nothing. */
  readonly sharp?: Int32Array | undefined;
}

/** A control mesh on which each edge has one or two faces and each vertex one fan. */
export interface Surface {
  /** Of the mesh's vertices, then of the further ones that sharp edges ask for. */
  readonly positions: Float64Array;
  readonly faces: Int32Array;
  /** The face beyond the edge from corner k to k + 1, NONE at the border, a `seam` at a sharp edge. */
  readonly beside: Int32Array;
  /**
   * `ring[starts[v]]` to `ring[starts[v + 1] - 1]` are the neighbours of v, counter-clockwise: of an inner vertex
   * beginning with the least, of a border vertex from its next to its previous border vertex.
   */
  readonly starts: Int32Array;
  readonly ring: Int32Array;
  /** Sharp edges are borders. */
  readonly isBorder: Uint8Array;
  /** Where a sharp edge ends, or more than two of them and of the border meet: it stays. */
  readonly isCorner: Uint8Array;
  /** The vertex on the other side of a crease, or NONE. */
  readonly twins: Int32Array;
}

/** @throws Problem in a sentence that names the edge or vertex, if the mesh is no such surface. */
export function surfaceOf({ positions, faces, sharp }: ControlMesh, name: string): Surface {
  const count = positions.length / 3;
  const mates = matesOf(faces, count, name);
  const beside = mates.map((mate) => Math.floor(mate / 3)); // -1 stays -1
  const rings = ringsOf(faces, beside, count, name);
  if (sharp && markSeams(sharp, faces, mates, beside, count, name))
    return cutOpen(positions, faces, beside, name);
  const isCorner = new Uint8Array(count);
  return { positions, faces, beside, ...rings, isCorner, twins: new Int32Array(count).fill(NONE) };
}

/** Neighbours of each vertex, and whether it is on the border. */
function ringsOf(faces: Int32Array, beside: Int32Array, count: number, name: string) {
  const { first, isBorder } = firstFaces(faces, beside, count);
  const starts = new Int32Array(count + 1);
  for (const v of faces) starts[v + 1]!++;
  for (let v = 0; v < count; v++) starts[v + 1]! += starts[v]! + isBorder[v]!;
  const ring = new Int32Array(starts[count]!);
  for (let v = 0; v < count; v++) {
    if (fillRing({ corners: faces }, beside, v, first[v]!, starts, ring)) continue;
    throw noSurface(name, `at vertex ${v} several fans of triangles touch`);
  }
  return { starts, ring, isBorder };
}

/** Write to `beside` which half-edges are sharp; returns whether any is. */
function markSeams(
  sharp: Int32Array,
  faces: Int32Array,
  mates: Int32Array,
  beside: Int32Array,
  count: number,
  name: string,
): boolean {
  const keyOf = (a: number, b: number) => Math.min(a, b) * count + Math.max(a, b);
  const wanted = new Set<number>();
  for (let i = 0; i < sharp.length; i += 2) wanted.add(keyOf(sharp[i]!, sharp[i + 1]!));
  const missing = new Set(wanted);
  let hasSeams = false;
  for (let i = 0; i < faces.length; i++) {
    const key = keyOf(faces[i]!, faces[endOf(i)]!);
    if (!wanted.has(key)) continue;
    missing.delete(key);
    if (mates[i] === NONE) continue;
    beside[i] = seam(0, mates[i]!);
    hasSeams = true;
  }
  for (const key of missing) {
    const edge = edgeOf(Math.floor(key / count), key % count);
    throw noSurface(name, `${edge} is to be sharp, and there is none`);
  }
  return hasSeams;
}

/** Give each sector of a vertex's fan, between two edges with no face beside, a vertex of its own. */
function cutOpen(positions: Float64Array, whole: Int32Array, beside: Int32Array, name: string): Surface {
  const count = positions.length / 3;
  const faces = whole.slice();
  const origins = sectors(whole, beside, count, faces);
  const edges = new Int32Array(count); // at each vertex, sharp or on the border
  for (let i = 0; i < whole.length; i++) {
    if (beside[i]! < 0) edges[whole[i]!]!++;
    if (beside[i] === NONE) edges[whole[endOf(i)]!]!++; // at a sharp one the other side begins there
  }
  const isCorner = Uint8Array.from(origins, (v) => (edges[v] !== 0 && edges[v] !== 2 ? 1 : 0));
  const twins = new Int32Array(origins.length).fill(NONE);
  for (let v = count; v < origins.length; v++) {
    if (isCorner[v]) continue;
    twins[v] = origins[v]!;
    twins[origins[v]!] = v;
  }
  const places = new Float64Array(3 * origins.length);
  origins.forEach((v, i) => {
    places.set(positions.subarray(3 * v, 3 * v + 3), 3 * i);
  });
  return {
    positions: places,
    faces,
    beside,
    ...ringsOf(faces, beside, origins.length, name),
    isCorner,
    twins,
  };
}

/** Write to `apart` the faces over sectors; returns the vertex that each was. The first one keeps its own. */
function sectors(faces: Int32Array, beside: Int32Array, count: number, apart: Int32Array): number[] {
  const mesh = { corners: faces };
  const isTaken = new Uint8Array(count);
  const origins = Array.from({ length: count }, (_, v) => v);
  for (let i = 0; i < faces.length; i++) {
    if (beside[i]! >= 0) continue;
    const v = faces[i]!;
    const own = isTaken[v] ? origins.push(v) - 1 : v;
    isTaken[v] = 1;
    let f = Math.floor(i / 3);
    let k = i % 3;
    while (f >= 0) {
      apart[3 * f + k] = own;
      f = beside[3 * f + ((k + 2) % 3)]!;
      if (f >= 0) k = cornerAt(mesh, f, v);
    }
  }
  return origins;
}

/** Half-edges are kept in a list for the lower of their two vertices, where the other half is looked for. */
function matesOf(faces: Int32Array, count: number, name: string): Int32Array {
  const mates = new Int32Array(faces.length).fill(NONE);
  const head = new Int32Array(count).fill(NONE);
  const next = new Int32Array(faces.length);
  for (let i = 0; i < faces.length; i++) {
    const from = faces[i]!;
    const to = faces[endOf(i)]!;
    if (from === to) throw noSurface(name, `triangle ${Math.floor(i / 3)} has the same vertex twice`);
    const low = Math.min(from, to);
    let mate = NONE;
    for (let j = head[low]!; j !== NONE; j = next[j]!) {
      if (faces[j]! + faces[endOf(j)]! !== from + to) continue; // the lower one is the same
      if (mate !== NONE) throw noSurface(name, `${edgeOf(from, to)} has more than two triangles`);
      mate = j;
    }
    if (mate !== NONE) {
      if (faces[mate] === from)
        throw noSurface(name, `the two triangles at ${edgeOf(from, to)} face opposite sides`);
      mates[i] = mate;
      mates[mate] = i;
    }
    next[i] = head[low]!;
    head[low] = i;
  }
  return mates;
}

export function edgeOf(from: number, to: number): string {
  return `the edge between vertices ${from} and ${to}`;
}

/** Where the half-edge ends that begins at corner i: the next corner of its triangle. */
function endOf(i: number): number {
  return i % 3 === 2 ? i - 2 : i + 1;
}

/** The face where each ring begins: at the border, or where the least neighbour is next. */
function firstFaces(faces: Int32Array, beside: Int32Array, count: number) {
  const first = new Int32Array(count).fill(NONE);
  const isBorder = new Uint8Array(count);
  const least = new Int32Array(count).fill(count);
  for (let i = 0; i < faces.length; i++) {
    if (beside[i]! >= 0) continue;
    first[faces[i]!] = Math.floor(i / 3);
    isBorder[faces[i]!] = 1;
  }
  for (let i = 0; i < faces.length; i++) {
    const v = faces[i]!;
    const w = faces[endOf(i)]!;
    if (isBorder[v] || w >= least[v]!) continue;
    least[v] = w;
    first[v] = Math.floor(i / 3);
  }
  return { first, isBorder };
}

/** Fill the ring of vertex v; false if not all its faces are in one fan. */
function fillRing(
  mesh: { readonly corners: Int32Array },
  beside: Int32Array,
  v: number,
  first: number,
  starts: Int32Array,
  ring: Int32Array,
): boolean {
  const { corners } = mesh;
  const end = starts[v + 1]!;
  let f = first;
  let i = starts[v]!;
  while (i < end) {
    const k = cornerAt(mesh, f, v);
    ring[i++] = corners[3 * f + ((k + 1) % 3)]!;
    const g = beside[3 * f + ((k + 2) % 3)]!;
    if (g < 0 && i < end) ring[i++] = corners[3 * f + ((k + 2) % 3)]!;
    if (g < 0 || g === first) break;
    f = g;
  }
  return i === end;
}

export function noSurface(name: string, why: string): Problem {
  return new Problem(
    "damaged",
    `${name} holds no surface that can be refined: ${why}. Build it again with: foveal build`,
  );
}
