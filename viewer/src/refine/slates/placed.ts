/**
 * A mesh in all its places as one mesh of copies, one after the other: so each copy's patches have depths of their own,
 * and what is told of them is one set of rows.
 *
 * The same as `placed` of `src/foveal/refine/slates_placements.py`.
 *
 * @module refine/slates/placed
 */
import { stretchOf } from "../../format/placements";
import type { PolygonMesh } from "../../format/polygons";

/**
 * Mirrored, faces are turned round; their first corners stay the first.
 *
 * @param matrices - Of 16 numbers each, row by row, the last row 0 0 0 1.
 */
export function placed(mesh: PolygonMesh, matrices: Float64Array): PolygonMesh {
  const times = matrices.length / 16;
  const vertices = mesh.positions.length / 3;
  const faces = mesh.starts.length - 1;
  const starts = new Int32Array(faces * times + 1);
  for (let f = 0; f < faces * times; f++) {
    starts[f + 1] = starts[f]! + mesh.starts[(f % faces) + 1]! - mesh.starts[f % faces]!;
  }
  return {
    positions: placesOf(mesh.positions, matrices),
    starts,
    corners: cornersOf(mesh, matrices),
    creaseEdges: numbered(mesh.creaseEdges, times, vertices),
    creaseSharpness: repeated(mesh.creaseSharpness, times),
    cornerVertices: numbered(mesh.cornerVertices, times, vertices),
    cornerSharpness: repeated(mesh.cornerSharpness, times),
    boundary: mesh.boundary,
    colours: mesh.colours && repeated(mesh.colours, times),
    uvs: mesh.uvs && repeated(mesh.uvs, times),
    holes: mesh.holes && numbered(mesh.holes, times, faces),
  };
}

/** Each coordinate is (m0 x + m1 y) + m2 z + m3. */
function placesOf(positions: Float64Array, matrices: Float64Array): Float64Array {
  const out = new Float64Array(positions.length * (matrices.length / 16));
  let at = 0;
  for (let base = 0; base < matrices.length; base += 16) {
    const m = matrices.subarray(base, base + 12);
    for (let v = 0; v < positions.length; v += 3) {
      const [x, y, z] = [positions[v]!, positions[v + 1]!, positions[v + 2]!];
      for (let j = 0; j < 12; j += 4) out[at++] = m[j]! * x + m[j + 1]! * y + m[j + 2]! * z + m[j + 3]!;
    }
  }
  return out;
}

function cornersOf({ positions, starts, corners }: PolygonMesh, matrices: Float64Array): Int32Array {
  const times = matrices.length / 16;
  const out = numbered(corners, times, positions.length / 3);
  for (let i = 0; i < times; i++) {
    if (!stretchOf(matrices.subarray(16 * i, 16 * i + 12)).isMirrored) continue;
    const base = i * corners.length;
    for (let f = 0; f + 1 < starts.length; f++) {
      out.subarray(base + starts[f]! + 1, base + starts[f + 1]!).reverse();
    }
  }
  return out;
}

function repeated(own: Float32Array, times: number): Float32Array {
  const out = new Float32Array(own.length * times);
  for (let i = 0; i < times; i++) out.set(own, i * own.length);
  return out;
}

/** Those of all copies of a mesh of so many vertices, or faces. */
function numbered(own: Int32Array, times: number, count: number): Int32Array {
  const out = new Int32Array(own.length * times);
  for (let i = 0; i < times; i++) {
    for (let j = 0; j < own.length; j++) out[i * own.length + j] = own[j]! + i * count;
  }
  return out;
}
