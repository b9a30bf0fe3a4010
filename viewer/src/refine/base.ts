/**
 * The control mesh's faces and vertices in a √3 refinement.
 *
 * The same as `src/foveal/refine/_kernels_sqrt3_base.py`, with its order of the arithmetic.
 *
 * @module refine/base
 */
import { setNormal } from "./measure";
import { BORDER, CORNER, INSIDE, LIMIT, Net, NONE, POINT, THIRD_VECTOR } from "./net";
import type { Surface } from "./surface";
import { turn } from "./turn";

/** Room to begin with, beyond the control mesh: pages that are never touched cost nothing. */
const FACES = 1 << 16;
const VERTICES = 1 << 15;

/** The net of a control mesh, nothing split. */
export function netOf(surface: Surface): Net {
  const { positions, faces, beside } = surface;
  const count = positions.length / 3;
  const faceCount = faces.length / 3;
  const net = new Net(2 * faceCount + FACES, count + faceCount + VERTICES, count);
  net.faceSlots = faceCount;
  net.vertexSlots = count;
  net.corners.set(faces);
  net.beside.set(beside);
  net.triples.fill(NONE, 0, 3 * count);
  net.pairs.fill(NONE, 0, count);
  net.twins.set(surface.twins);
  for (let i = 0; i < faces.length; i++) net.around[faces[i]!] = Math.floor(i / 3);
  for (let v = 0; v < count; v++) {
    for (let k = 0; k < 3; k++) {
      net.points[POINT * v + k] = net.points[POINT * v + LIMIT + k] = positions[3 * v + k]!;
    }
    if (surface.starts[v] === surface.starts[v + 1]) continue;
    if (!surface.isBorder[v]) innerVertex(net, surface, v);
    else {
      if (surface.isCorner[v]) net.kinds[v] = CORNER;
      else borderVertex(net, surface, v);
      fanNormal(net, surface, v);
    }
  }
  return net;
}

/** Its neighbours on the border, as vectors. */
function borderVertex(net: Net, { positions, starts, ring }: Surface, v: number): void {
  const begin = starts[v]!;
  const end = starts[v + 1]!;
  const previous = 3 * ring[end - 1]!;
  const next = 3 * ring[begin]!;
  net.kinds[v] = BORDER;
  for (let k = 0; k < 3; k++) {
    const before = positions[previous + k]!;
    const after = positions[next + k]!;
    net.points[POINT * v + LIMIT + k] = after - before;
    net.points[POINT * v + THIRD_VECTOR + k] = before + after - 2 * positions[3 * v + k]!;
  }
}

/** A fan's mean normal: the limit's tangent across the border is not known. */
function fanNormal(net: Net, { positions, starts, ring }: Surface, v: number): void {
  const begin = starts[v]!;
  const end = starts[v + 1]!;
  let x = 0;
  let y = 0;
  let z = 0;
  for (let i = begin; i < end - 1; i++) {
    const [ux, uy, uz] = difference(positions, ring[i]!, v);
    const [wx, wy, wz] = difference(positions, ring[i + 1]!, v);
    x = x + uy * wz - uz * wy;
    y = y + uz * wx - ux * wz;
    z = z + ux * wy - uy * wx;
  }
  setNormal(net, v, x, y, z);
}

function difference(positions: Float64Array, a: number, b: number): [x: number, y: number, z: number] {
  return [
    positions[3 * a]! - positions[3 * b]!,
    positions[3 * a + 1]! - positions[3 * b + 1]!,
    positions[3 * a + 2]! - positions[3 * b + 2]!,
  ];
}

/** Its limit, how much nearer to it a level comes, and its normal by the tangents of the ring. */
function innerVertex(net: Net, { positions, starts, ring }: Surface, v: number): void {
  const begin = starts[v]!;
  const n = starts[v + 1]! - begin;
  const share = (4 - 2 * turn(1, n)[0]) / 9;
  net.kinds[v] = INSIDE;
  net.shrinks[v] = 2 / 3 - share;
  const s = [0, 0, 0];
  const t = [0, 0, 0];
  for (let k = 0; k < 3; k++) {
    let total = 0;
    for (let i = 0; i < n; i++) total += positions[3 * ring[begin + i]! + k]!;
    net.points[POINT * v + LIMIT + k] = (positions[3 * v + k]! + (3 * share * total) / n) / (1 + 3 * share);
  }
  for (let i = 0; i < n; i++) {
    const [cosine, sine] = turn(i, n);
    for (let k = 0; k < 3; k++) {
      const x = positions[3 * ring[begin + i]! + k]!;
      s[k]! += cosine * x;
      t[k]! += sine * x;
    }
  }
  const [sx, sy, sz] = s as [number, number, number];
  const [tx, ty, tz] = t as [number, number, number];
  setNormal(net, v, sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx);
}
