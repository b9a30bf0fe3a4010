/**
 * Who is beside whom in a polygon mesh, and how sharp its edges are.
 *
 * A corner of a face is also the edge from it to the next corner of the face. What is no surface is refused with
 * a sentence: foveal writes no such file, but a page takes files from anywhere.
 *
 * @module refine/slates/topology
 */
import type { PolygonMesh } from "../../format/polygons";
import { edgeOf, noSurface } from "../surface";
import { INFINITE, NONE } from "./layout";

/** Faces with their edges and tags. */
export interface Polygons {
  /** Vertices. */
  readonly count: number;
  readonly starts: Int32Array;
  readonly corners: Int32Array;
  /** The next and the previous corner of the face. */
  readonly following: Int32Array;
  readonly previous: Int32Array;
  /** The same edge seen from its other face, or NONE. */
  readonly mates: Int32Array;
  /** The edge's number, by rising vertices; `ends` are its two vertices, the lower first. */
  readonly edge: Int32Array;
  readonly ends: Int32Array;
  /** Of edges: 0 smooth, infinity at borders and from 10 on; and of vertices. */
  readonly sharp: Float64Array;
  readonly vertexSharp: Float64Array;
}

/** The corners around each vertex, counter-clockwise: of an inner one from its least, else from the border on. */
export interface Fans {
  readonly fanStarts: Int32Array;
  readonly fan: Int32Array;
  /** Where a corner is among those of its vertex. */
  readonly place: Int32Array;
}

/** @throws Problem in a sentence that names the face, edge or vertex, if the mesh is no surface. */
export function polygonsFrom(mesh: PolygonMesh, name: string): Polygons {
  const { starts, corners } = mesh;
  const count = mesh.positions.length / 3;
  refuseRepeated(starts, corners, count, name);
  const vertexSharp = new Float64Array(count);
  mesh.cornerVertices.forEach((v, i) => {
    vertexSharp[v] = unending(mesh.cornerSharpness[i]!);
  });
  if (mesh.boundary === "edge_and_corner") {
    const faces = new Int32Array(count);
    for (const v of corners) faces[v]!++;
    for (let v = 0; v < count; v++) if (faces[v] === 1) vertexSharp[v] = Infinity;
  }
  const polygons = joined(count, starts, corners, vertexSharp, name);
  tagEdges(polygons, mesh.creaseEdges, mesh.creaseSharpness, name);
  for (let h = 0; h < corners.length; h++) {
    if (polygons.mates[h] === NONE) polygons.sharp[polygons.edge[h]!] = Infinity;
  }
  return polygons;
}

/** As a double, infinite from 10 on. */
export function unending(sharpness: number): number {
  return sharpness >= INFINITE ? Infinity : sharpness;
}

/** Faces over their edges, all smooth but for what vertices say. */
export function joined(
  count: number,
  starts: Int32Array,
  corners: Int32Array,
  vertexSharp: Float64Array,
  name: string,
): Polygons {
  const following = new Int32Array(corners.length);
  const previous = new Int32Array(corners.length);
  for (let f = 0; f + 1 < starts.length; f++) {
    const [begin, end] = [starts[f]!, starts[f + 1]!];
    for (let h = begin; h < end; h++) {
      following[h] = h + 1 < end ? h + 1 : begin;
      previous[h] = h > begin ? h - 1 : end - 1;
    }
  }
  const links = edgesOf(count, corners, following, name);
  const sharp = new Float64Array(links.ends.length / 2);
  return { count, starts, corners, following, previous, ...links, sharp, vertexSharp };
}

/** Numbers of edges by rising lower, then upper vertex; and who shares them. */
function edgesOf(count: number, corners: Int32Array, following: Int32Array, name: string) {
  const order = byEdge(count, corners, following);
  const mates = new Int32Array(corners.length).fill(NONE);
  const edge = new Int32Array(corners.length);
  const ends: number[] = [];
  let [lower, upper] = [NONE, NONE];
  order.forEach((h, i) => {
    const [from, to] = [corners[h]!, corners[following[h]!]!];
    if (Math.min(from, to) === lower && Math.max(from, to) === upper) {
      const mate = order[i - 1]!;
      if (mates[mate] !== NONE) throw noSurface(name, `${edgeOf(from, to)} has more than two faces`);
      if (corners[mate] === from) {
        throw noSurface(name, `the two faces at ${edgeOf(from, to)} face opposite sides`);
      }
      mates[mate] = h;
      mates[h] = mate;
    } else {
      lower = Math.min(from, to);
      upper = Math.max(from, to);
      ends.push(lower, upper);
    }
    edge[h] = ends.length / 2 - 1;
  });
  return { mates, edge, ends: Int32Array.from(ends) };
}

/** Corners by their edge's lower, then upper vertex, then as they come: counted twice, since that is stable. */
function byEdge(count: number, corners: Int32Array, following: Int32Array): Int32Array {
  let order = new Int32Array(corners.length);
  for (let h = 0; h < order.length; h++) order[h] = h;
  for (const least of [Math.max, Math.min]) {
    const keyOf = (h: number) => least(corners[h]!, corners[following[h]!]!);
    const starts = new Int32Array(count + 1);
    for (const h of order) starts[keyOf(h) + 1]!++;
    for (let v = 0; v < count; v++) starts[v + 1]! += starts[v]!;
    const next = new Int32Array(order.length);
    for (const h of order) next[starts[keyOf(h)]!++] = h;
    order = next;
  }
  return order;
}

function tagEdges({ count, ends, sharp }: Polygons, edges: Int32Array, values: Float32Array, name: string) {
  if (edges.length === 0) return;
  const first = new Int32Array(count + 1); // of the edges whose lower vertex is v
  for (let e = 0; e < ends.length; e += 2) first[ends[e]! + 1]!++;
  for (let v = 0; v < count; v++) first[v + 1]! += first[v]!;
  for (let i = 0; i < values.length; i++) {
    const [a, b] = [edges[2 * i]!, edges[2 * i + 1]!];
    const [lower, upper] = [Math.min(a, b), Math.max(a, b)];
    let [e, end] = [first[lower]!, first[lower + 1]!];
    while (e < end) {
      const middle = (e + end) >> 1;
      if (ends[2 * middle + 1]! < upper) e = middle + 1;
      else end = middle;
    }
    if (e === first[lower + 1] || ends[2 * e + 1] !== upper) {
      throw noSurface(name, `${edgeOf(a, b)} is to be sharp, and there is none`);
    }
    sharp[e] = unending(values[i]!);
  }
}

function refuseRepeated(starts: Int32Array, corners: Int32Array, count: number, name: string): void {
  const last = new Int32Array(count).fill(NONE);
  for (let f = 0; f + 1 < starts.length; f++) {
    for (let h = starts[f]!; h < starts[f + 1]!; h++) {
      if (last[corners[h]!] === f) throw noSurface(name, `face ${f} has vertex ${corners[h]} twice`);
      last[corners[h]!] = f;
    }
  }
}

/** @throws Problem if the faces at a vertex are not one fan. */
export function fansOf({ count, corners, previous, mates }: Polygons, name: string): Fans {
  const first = new Int32Array(count).fill(NONE);
  for (let h = corners.length - 1; h >= 0; h--) first[corners[h]!] = h;
  for (let h = 0; h < corners.length; h++) if (mates[h] === NONE) first[corners[h]!] = h;
  const fanStarts = new Int32Array(count + 1);
  for (const v of corners) fanStarts[v + 1]!++;
  const [fan, place] = [new Int32Array(corners.length), new Int32Array(corners.length)];
  for (let v = 0; v < count; v++) {
    fanStarts[v + 1]! += fanStarts[v]!;
    const [begin, end] = [fanStarts[v]!, fanStarts[v + 1]!];
    let h = first[v]!;
    for (let i = begin; i < end; i++) {
      if (h === NONE || (i > begin && h === first[v])) {
        throw noSurface(name, `at vertex ${v} several fans of faces touch`);
      }
      fan[i] = h;
      place[h] = i - begin;
      h = mates[previous[h]!]!;
    }
  }
  return { fanStarts, fan, place };
}
