/**
 * A control mesh made ready for tessellation: all that depends on its topology and tags, not on positions.
 *
 * @module refine/slates/net
 */
import type { PolygonMesh } from "../../format/polygons";
import { firstStep } from "./firstStep";
import { NONE, REGULAR, SMOOTH, TAGGED } from "./layout";
import { type MaskTables, maskTables, sideTables } from "./tables";
import { type Fans, fansOf, type Polygons, polygonsFrom, unending } from "./topology";

/** Quadrangles with what their patches read. Corner h of quadrangle f is 4 f + k, and its edge's name. */
export interface SlateNet extends MaskTables, Fans {
  /** Counter-clockwise; side k of a patch goes from corner k to k + 1. */
  readonly corners: Int32Array;
  /** The same edge seen from its other face, or NONE. */
  readonly mates: Int32Array;
  /** The sixteen vertices of the table at depth 0, of each patch. */
  readonly grid: Int32Array;
  /** Of each vertex its spokes e_i, then f_i across its faces, from the ring's own first. */
  readonly ringStarts: Int32Array;
  readonly ring: Int32Array;
  /** The spokes' sharpness, where spokes are in `ring`. */
  readonly spokes: Float64Array;
  /** Faces at a vertex; REGULAR, SMOOTH or TAGGED; its own sharpness. */
  readonly fans: Int32Array;
  readonly kinds: Uint8Array;
  readonly vertexSharp: Float64Array;
  /** Of sides; infinite at borders. */
  readonly sharp: Float64Array;
  /** A table of `sideMasks` for a semi-sharp side. */
  readonly sideClass: Int32Array;
  readonly sideMasks: Float64Array;
}

/** Quadrangles for slates, of any polygon mesh: one step is made first where a face is none. */
export interface SlateCage {
  readonly net: SlateNet;
  readonly patches: number;
  /** Which face of the mesh a quadrangle is of. */
  readonly faces: Int32Array;
  /** 0 for holes: the mesh's own, and those that the boundary rule "none" leaves. */
  readonly isShown: Uint8Array;
  /** Rows of three of the quadrangles' vertices, of those of the mesh's. */
  readonly points: (rows: Float64Array) => Float64Array;
}

/** @throws Problem in a sentence, if the mesh is no surface. */
export function slateCage(mesh: PolygonMesh, name: string): SlateCage {
  const polygons = polygonsFrom(mesh, name);
  fansOf(polygons, name); // or it is no surface
  const isHole = holesOf(mesh, polygons);
  let steps = Math.max(stepsOf(polygons.sharp), stepsOf(polygons.vertexSharp));
  const { starts } = polygons;
  if (starts.every((start, f) => start === 4 * f)) {
    const faces = Int32Array.from({ length: starts.length - 1 }, (_, f) => f);
    return caged(polygons, faces, isHole, (rows) => rows, steps, name);
  }
  const stepped = firstStep(polygons, name);
  steps = Math.max(steps - 1, 0);
  return caged(stepped.polygons, stepped.faces, isHole, stepped.points, steps, name);
}

function caged(
  polygons: Polygons,
  faces: Int32Array,
  isHole: Uint8Array,
  points: SlateCage["points"],
  steps: number,
  name: string,
): SlateCage {
  const isShown = Uint8Array.from(faces, (f) => 1 - isHole[f]!);
  return { net: netOf(polygons, steps, name), patches: faces.length, faces, isShown, points };
}

/** After how many nothing semi-sharp is left. */
function stepsOf(sharpness: Float64Array): number {
  return Math.ceil(sharpness.reduce((most, s) => (s < Infinity ? Math.max(most, s) : most), 0));
}

/** The mesh's own; with the boundary "none" also faces at the ends of border edges not sharp for ever. */
function holesOf(mesh: PolygonMesh, { count, starts, corners, edge, ends, mates }: Polygons): Uint8Array {
  const isHole = new Uint8Array(starts.length - 1);
  for (const f of mesh.holes ?? []) isHole[f] = 1;
  if (mesh.boundary !== "none") return isHole;
  const tagged = new Set<number>();
  mesh.creaseSharpness.forEach((s, i) => {
    const [a, b] = [mesh.creaseEdges[2 * i]!, mesh.creaseEdges[2 * i + 1]!];
    const key = Math.min(a, b) * count + Math.max(a, b);
    if (unending(s) === Infinity) tagged.add(key);
    else tagged.delete(key); // of several tags the last holds
  });
  const isNear = new Uint8Array(count);
  for (let h = 0; h < corners.length; h++) {
    if (mates[h] !== NONE) continue;
    const [a, b] = [ends[2 * edge[h]!]!, ends[2 * edge[h]! + 1]!];
    if (!tagged.has(a * count + b)) isNear[a] = isNear[b] = 1;
  }
  for (let f = 0; f < isHole.length; f++) {
    for (let h = starts[f]!; h < starts[f + 1]!; h++) isHole[f]! |= isNear[corners[h]!]!;
  }
  return isHole;
}

function netOf(polygons: Polygons, steps: number, name: string): SlateNet {
  const { corners, mates, vertexSharp } = polygons;
  const fans = fansOf(polygons, name);
  const sharp = new Float64Array(corners.length);
  for (let h = 0; h < sharp.length; h++) sharp[h] = polygons.sharp[polygons.edge[h]!]!;
  const rings = ringsOf(polygons, fans, sharp);
  const kinds = kindsOf(polygons, rings.fans, sharp);
  const parts = { corners, mates, vertexSharp, sharp, kinds, ...fans, ...rings };
  return {
    ...parts,
    grid: gridOf(parts),
    ...sideTables(sharp),
    ...maskTables(parts, steps, name),
  };
}

function kindsOf({ corners, following, vertexSharp }: Polygons, fans: Int32Array, sharp: Float64Array) {
  const kinds = Uint8Array.from(fans, (n, v) => (vertexSharp[v]! > 0 ? TAGGED : n === 4 ? REGULAR : SMOOTH));
  for (let h = 0; h < corners.length; h++) {
    if (!(sharp[h]! > 0)) continue;
    kinds[corners[h]!] = TAGGED;
    kinds[corners[following[h]!]!] = TAGGED;
  }
  return kinds;
}

/** The ring's vertices, e then f, and the sharpness of the spokes. */
function ringsOf({ count, corners, mates }: Polygons, { fanStarts, fan }: Fans, sharp: Float64Array) {
  const ringStarts = new Int32Array(count + 1);
  const fans = new Int32Array(count);
  for (let v = 0; v < count; v++) {
    const [begin, end] = [fanStarts[v]!, fanStarts[v + 1]!];
    fans[v] = end - begin;
    const isOpen = end > begin && mates[fan[begin]!] === NONE;
    ringStarts[v + 1] = ringStarts[v]! + 2 * fans[v]! + (isOpen ? 1 : 0);
  }
  const ring = new Int32Array(ringStarts[count]!);
  const spokes = new Float64Array(ring.length);
  const corner = (h: number, k: number) => corners[h - (h % 4) + ((h + k) % 4)]!;
  for (let v = 0; v < count; v++) {
    const [begin, end] = [fanStarts[v]!, fanStarts[v + 1]!];
    let at = ringStarts[v]!;
    for (let i = begin; i < end; i++) {
      ring[at] = corner(fan[i]!, 1);
      spokes[at++] = sharp[fan[i]!]!;
    }
    if (at + end - begin < ringStarts[v + 1]!) {
      const last = fan[end - 1]!;
      ring[at] = corner(last, 3);
      spokes[at++] = sharp[last - (last % 4) + ((last + 3) % 4)]!;
    }
    for (let i = begin; i < end; i++) ring[at++] = corner(fan[i]!, 2);
  }
  return { ringStarts, ring, spokes, fans };
}

type GridParts = Pick<SlateNet, "corners" | "place" | "fans" | "ringStarts" | "ring">;

/**
 * The sixteen vertices of each table at depth 0, row by row; what is absent is the own corner. Where a corner has other
 * than four faces, the cell across it means nothing.
 */
function gridOf({ corners, place, fans, ringStarts, ring }: GridParts): Int32Array {
  const grid = new Int32Array(4 * corners.length);
  for (let h = 0; h < corners.length; h++) {
    const v = corners[h]!;
    const [n, begin, o] = [fans[v]!, ringStarts[v]!, place[h]!];
    const spokes = ringStarts[v + 1]! - begin - n;
    const isOpen = spokes > n;
    const isInside = o > 0 || !isOpen;
    const base = 4 * (h & ~3);
    const cells = CELLS[h & 3]!;
    grid[base + cells[0]!] = v;
    grid[base + cells[1]!] = isInside ? ring[begin + spokes + ((o + n - 1) % n)]! : v;
    grid[base + cells[2]!] = isInside ? ring[begin + ((o + spokes - 1) % spokes)]! : v;
    grid[base + cells[3]!] = n === 4 && !isOpen ? ring[begin + spokes + ((o + 2) % n)]! : v;
  }
  return grid;
}

/** Of each corner of a patch its own cell of the table, that outside ahead of it, outside it, and across it. */
const CELLS = [0, 1, 2, 3].map((k) => {
  const own = [0, -1, -1, -1];
  return [0, 1, 0, -1].map((column, i) => cellOf(k, own[i]!, column));
});

/** From a corner's own frame (row, column) to the table's, turned k times. */
function cellOf(k: number, ownRow: number, ownColumn: number): number {
  let [row, column] = [ownRow, ownColumn];
  for (let i = 0; i < k; i++) [row, column] = [column, -row];
  if (k === 1 || k === 2) column += 1;
  if (k >= 2) row += 1;
  return 4 * (row + 1) + column + 1;
}
