/**
 * Whether a triangle is to be refined for a view: from its corners and limit normals alone.
 *
 * - `view`, 24 numbers: the eye, pixels per radian, five frustum planes as (normal, offset).
 * - `limits`, 9 numbers: for front faces, silhouettes and back faces the most iterations, the edge in pixels that is
 *   short enough, the bend that is flat enough as 1 - cosine.
 *
 * The same as `src/foveal/refine/_kernels_criteria.py`, with its order of the arithmetic.
 *
 * Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
 * √3-subdivision (the criteria).
 *
 * @module refine/wanted
 */
const PIXELS = 3;
const PLANES = 4;

const THIRD = 1 / 3;

/** Rows of `limits`, by their first number. */
const FRONT = 0;
const SILHOUETTE = 3;
const BACK = 6;
const EDGE = 1;
const BEND = 2;

/**
 * A triangle is outside if a ball around its middle is, of this radius in longest edges: corners are at most
 * 1 / sqrt(3) away, and as much again is left for where refinement moves it.
 */
const BALL = 1.16;

/**
 * Of the last answer: it stays the same as long as neither the eye nor, as seen from any point of the surface, a
 * plane of the frustum has moved by this much.
 */
export const SLACK = new Float64Array(1);

/** The triangle's middle as seen from the eye, how far that is; its normal; how little it bends. */
const T = new Float64Array(8);

/**
 * Whether to split the triangle of a level at vertices u, v, w, whose corners are the nine numbers `at`; SLACK says
 * how long that holds.
 *
 * In the paper's order: frustum, then facing, then silhouette. A silhouette passes where the triangle and the limit
 * surface at its corner face different ways, or would if it bent as much again. Above level 0 only the first
 * corner's normal is asked: those of the others may not be there yet.
 */
export function isWanted(
  view: Float64Array,
  limits: Float64Array,
  level: number,
  at: Float64Array,
  normals: Float32Array,
  u: number,
  v: number,
  w: number,
): boolean {
  SLACK[0] = Infinity;
  if (level >= Math.max(limits[FRONT]!, Math.max(limits[SILHOUETTE]!, limits[BACK]!))) return false;
  const ax = at[0]!;
  const ay = at[1]!;
  const az = at[2]!;
  const bx = at[3]!;
  const by = at[4]!;
  const bz = at[5]!;
  const cx = at[6]!;
  const cy = at[7]!;
  const cz = at[8]!;
  const ux = bx - ax;
  const uy = by - ay;
  const uz = bz - az;
  const vx = cx - ax;
  const vy = cy - ay;
  const vz = cz - az;
  const wx = cx - bx;
  const wy = cy - by;
  const wz = cz - bz;
  const uu = ux * ux + uy * uy + uz * uz;
  const vv = vx * vx + vy * vy + vz * vz;
  const ww = wx * wx + wy * wy + wz * wz;
  const longest = Math.sqrt(Math.max(uu, Math.max(vv, ww)));
  const x = (ax + bx + cx) * THIRD;
  const y = (ay + by + cy) * THIRD;
  const z = (az + bz + cz) * THIRD;
  const dx = view[0]! - x;
  const dy = view[1]! - y;
  const dz = view[2]! - z;
  const away = Math.sqrt(dx * dx + dy * dy + dz * dz);
  const reach = BALL * longest;
  let slack = Infinity;
  for (let i = PLANES; i < PLANES + 20; i += 4) {
    const inside = view[i]! * x + view[i + 1]! * y + view[i + 2]! * z + view[i + 3]! + reach;
    if (inside < 0) {
      SLACK[0] = trusted(-inside, away);
      return false;
    }
    slack = Math.min(slack, inside);
  }
  T[0] = dx;
  T[1] = dy;
  T[2] = dz;
  T[3] = away;
  T[4] = uy * vz - uz * vy;
  T[5] = uz * vx - ux * vz;
  T[6] = ux * vy - uy * vx;
  SLACK[0] = slack;
  const kind = facing(level, normals, u, v, w);
  return isCoarse(view, limits, level, kind, longest);
}

/** Which way the triangle in T faces; T[7] is then how little it bends, as a cosine. */
function facing(level: number, normals: Float32Array, u: number, v: number, w: number): number {
  const dx = T[0]!;
  const dy = T[1]!;
  const dz = T[2]!;
  const nx = T[4]!;
  const ny = T[5]!;
  const nz = T[6]!;
  const length = Math.sqrt(nx * nx + ny * ny + nz * nz);
  const scale = length > 0 ? 1 / length : 0;
  let low = (nx * dx + ny * dy + nz * dz) * scale;
  let high = low;
  let least = 1;
  const count = level === 0 ? 3 : 1;
  for (let i = 0; i < count; i++) {
    const k = 3 * (i === 0 ? u : i === 1 ? v : w);
    const mx = normals[k]!;
    const my = normals[k + 1]!;
    const mz = normals[k + 2]!;
    const side = mx * dx + my * dy + mz * dz;
    low = Math.min(low, side);
    high = Math.max(high, side);
    least = Math.min(least, (mx * nx + my * ny + mz * nz) * scale);
  }
  const front = 2 * low - high;
  const back = low - 2 * high;
  const kind = front > 0 ? FRONT : back > 0 ? BACK : SILHOUETTE;
  // `low` changes as quickly as the eye moves at most, `high - low` by the normals' distance times that.
  const spread = level > 0 ? Math.sqrt(Math.max(2 - 2 * least, 0)) : 2;
  const margin = kind === SILHOUETTE ? Math.min(-front, -back) : Math.max(front, back);
  SLACK[0] = Math.min(SLACK[0]!, margin / (1 + spread));
  T[7] = least;
  return kind;
}

/** Whether the limits for a triangle of this kind are all still to be reached. */
function isCoarse(
  view: Float64Array,
  limits: Float64Array,
  level: number,
  kind: number,
  longest: number,
): boolean {
  const away = T[3]!;
  const edge = limits[kind + EDGE]!;
  if (level >= limits[kind]! || 1 - T[7]! < limits[kind + BEND]!) {
    SLACK[0] = trusted(SLACK[0]!, away);
    return false;
  }
  if (edge > 0) {
    const reach = (view[PIXELS]! * longest) / edge;
    SLACK[0] = trusted(Math.min(SLACK[0]!, Math.abs(reach - away)), away);
    return reach > away;
  }
  SLACK[0] = trusted(SLACK[0]!, away);
  return true;
}

/** A slack that rounding cannot have made too large. */
function trusted(slack: number, away: number): number {
  return 0.999 * slack - 1e-12 * away;
}
