/**
 * The control mesh of a refinement: an oriented surface, with its neighbours, rings and border.
 *
 * The same as `src/foveal/refine/cage.py`. What is no surface is refused with a sentence: foveal writes no such
 * file, but a page takes files from anywhere.
 *
 * @module refine/surface
 */
import { Problem } from "../format/problem";
import { NONE } from "./net";
import { cornerAt } from "./slots";

/** A triangle mesh as a `.fov` of kind `cage` has it. */
export interface ControlMesh {
  /** Three doubles a vertex, finite, in the asset's unit. */
  readonly positions: Float64Array;
  /** Three vertices a face, each below the number of vertices; counter-clockwise. */
  readonly faces: Int32Array;
}

/** A control mesh on which each edge has one or two faces and each vertex one fan. */
export interface Surface extends ControlMesh {
  /** The face beyond the edge from corner k to k + 1, NONE at the border. */
  readonly beside: Int32Array;
  /**
   * `ring[starts[v]]` to `ring[starts[v + 1] - 1]` are the neighbours of v, counter-clockwise: of an inner vertex
   * beginning with the least, of a border vertex from its next to its previous border vertex.
   */
  readonly starts: Int32Array;
  readonly ring: Int32Array;
  readonly isBorder: Uint8Array;
}

/** @throws Problem in a sentence that names the edge or vertex, if the mesh is no such surface. */
export function surfaceOf(mesh: ControlMesh, name: string): Surface {
  const { positions, faces } = mesh;
  const count = positions.length / 3;
  const beside = facesBeside(faces, count, name);
  const { first, isBorder } = firstFaces(faces, beside, count);
  const starts = new Int32Array(count + 1);
  for (const v of faces) starts[v + 1]!++;
  for (let v = 0; v < count; v++) starts[v + 1]! += starts[v]! + isBorder[v]!;
  const ring = new Int32Array(starts[count]!);
  for (let v = 0; v < count; v++) {
    if (fillRing({ corners: faces }, beside, v, first[v]!, starts, ring)) continue;
    throw noSurface(name, `at vertex ${v} several fans of triangles touch`);
  }
  return { positions, faces, beside, starts, ring, isBorder };
}

/** Half-edges are kept in a list for the lower of their two vertices, where the other half is looked for. */
function facesBeside(faces: Int32Array, count: number, name: string): Int32Array {
  const beside = new Int32Array(faces.length).fill(NONE);
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
      beside[i] = Math.floor(mate / 3);
      beside[mate] = Math.floor(i / 3);
    }
    next[i] = head[low]!;
    head[low] = i;
  }
  return beside;
}

function edgeOf(from: number, to: number): string {
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
    if (beside[i] !== NONE) continue;
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
    if (g === NONE && i < end) ring[i++] = corners[3 * f + ((k + 2) % 3)]!;
    if (g === NONE || g === first) break;
    f = g;
  }
  return i === end;
}

function noSurface(name: string, why: string): Problem {
  return new Problem(
    "damaged",
    `${name} holds no surface that can be refined: ${why}. Build it again with: foveal build`,
  );
}
