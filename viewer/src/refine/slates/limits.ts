/**
 * Limit points and normals of control vertices: each once, so that all patches there have the same bits.
 *
 * @module refine/slates/limits
 */
import type { SlateNet } from "./net";
import type { Rows } from "./work";

/** Of the product of the tangents' lengths: below it a cross product is rounding. */
const TINY = 1e-12;

/** One column of a control mesh, positions or another attribute of three, and its limits at vertices. */
export class Limits {
  /** Of vertices, three each; of their sectors, where it is positions. */
  readonly cornerPoints: Float64Array;
  readonly cornerNormals: Float64Array;

  constructor(
    net: SlateNet,
    readonly points: Float64Array,
    isSurface: boolean,
  ) {
    this.cornerPoints = new Float64Array(points.length);
    this.cornerNormals = new Float64Array(isSurface ? 3 * net.normalStarts.at(-1)! : 0);
    for (let v = 0; 3 * v < points.length; v++) {
      vertexPoint(net, points, v, this.cornerPoints);
      if (isSurface) vertexNormals(net, points, v, this.cornerNormals);
    }
  }

  /** What corner h has into row o. */
  put(net: SlateNet, h: number, o: number, { positions, normals }: Rows, isSurface: boolean): void {
    const p = 3 * net.corners[h]!;
    const q = 3 * net.normalOf[h]!;
    for (let x = 0; x < 3; x++) {
      positions[3 * o + x] = this.cornerPoints[p + x]!;
      if (isSurface) normals[3 * o + x] = this.cornerNormals[q + x]!;
    }
  }
}

function vertexPoint(net: SlateNet, points: Float64Array, v: number, out: Float64Array): void {
  weigh(net, points, v, net.maskStarts[net.maskOf[v]!]!, 0);
  for (let x = 0; x < 3; x++) out[3 * v + x] = scratch[x]!;
}

/** Of all its sectors. */
function vertexNormals(net: SlateNet, points: Float64Array, v: number, out: Float64Array): void {
  const mask = net.maskOf[v]!;
  const { sectors } = net;
  let at = 3 * net.normalStarts[v]!;
  for (let s = 4 * net.sectorStarts[mask]!; s < 4 * net.sectorStarts[mask + 1]!; s += 4) {
    let length = cross(net, points, v, sectors[s]!, sectors[s + 1]!);
    if (!(length > 0)) length = cross(net, points, v, sectors[s + 2]!, sectors[s + 3]!);
    const share = length > 0 ? 1 / length : 0;
    // The zero added makes -0 the other zero.
    for (let x = 0; x < 3; x++) out[at++] = scratch[x]! * share + 0;
  }
}

/** A sum of cross products, and its two factors of the moment. */
const scratch = new Float64Array(9);

/** A row of weights times the ring of v, to scratch[to ..]. */
function weigh(net: SlateNet, points: Float64Array, v: number, row: number, to: number): void {
  const { weights, ring, ringStarts } = net;
  const begin = ringStarts[v]!;
  const size = ringStarts[v + 1]! - begin + 1;
  let w = weights[row]!;
  let x = w * points[3 * v]!;
  let y = w * points[3 * v + 1]!;
  let z = w * points[3 * v + 2]!;
  for (let j = 1; j < size; j++) {
    w = weights[row + j]!;
    const u = 3 * ring[begin + j - 1]!;
    x += w * points[u]!;
    y += w * points[u + 1]!;
    z += w * points[u + 2]!;
  }
  scratch[to] = x;
  scratch[to + 1] = y;
  scratch[to + 2] = z;
}

/** The sum of cross products of pairs of rows; returns its length, 0 where it is nothing but rounding. */
function cross(net: SlateNet, points: Float64Array, v: number, first: number, count: number): number {
  const size = net.ringStarts[v + 1]! - net.ringStarts[v]! + 1;
  const row = net.maskStarts[net.maskOf[v]!]!;
  let [x, y, z, most] = [0, 0, 0, 0];
  for (let i = 0; i < count; i++) {
    const at = row + (first + 2 * i) * size;
    weigh(net, points, v, at, 3);
    weigh(net, points, v, at + size, 6);
    const [ax, ay, az] = [scratch[3]!, scratch[4]!, scratch[5]!];
    const [bx, by, bz] = [scratch[6]!, scratch[7]!, scratch[8]!];
    x += ay * bz - az * by;
    y += az * bx - ax * bz;
    z += ax * by - ay * bx;
    most += Math.sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz));
  }
  scratch.set([x, y, z]);
  const length = Math.sqrt(x * x + y * y + z * z);
  return length > TINY * most ? length : 0;
}
