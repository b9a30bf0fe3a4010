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
  const ux = at[3]! - at[0]!;
  const uy = at[4]! - at[1]!;
  const uz = at[5]! - at[2]!;
  const vx = at[6]! - at[0]!;
  const vy = at[7]! - at[1]!;
  const vz = at[8]! - at[2]!;
  const longest = longestEdge(at, ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz);
  const x = (at[0]! + at[3]! + at[6]!) * THIRD;
  const y = (at[1]! + at[4]! + at[7]!) * THIRD;
  const z = (at[2]! + at[5]! + at[8]!) * THIRD;
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
  const nx = uy * vz - uz * vy;
  const ny = uz * vx - ux * vz;
  const nz = ux * vy - uy * vx;
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
  const ease = 1 / (1 + spread);
  const answer = judge(
    limits,
    kind,
    level,
    1 - least,
    view[PIXELS]! * longest,
    away,
    front * ease,
    back * ease,
  );
  SLACK[0] = trusted(Math.min(slack, MARGIN[0]!), away);
  return answer;
}

/** Of the last answers of `isCoarse` and `judge`: how far the eye may move before they change. */
const MARGIN = new Float64Array(1);

/**
 * Whether a kind's limits ask for more; MARGIN says how far the eye may move before they do not, or do.
 *
 * `front` and `back` say how far the eye is, at least, from where this would be a front or no front any more, a back
 * or no back any more. Another kind that says the same is none to beware of.
 */
function judge(
  limits: Float64Array,
  kind: number,
  level: number,
  bend: number,
  size: number,
  away: number,
  front: number,
  back: number,
): boolean {
  const answer = isCoarse(limits, kind, level, bend, size, away);
  let margin = MARGIN[0]!;
  for (let other = FRONT; other <= BACK; other += SILHOUETTE) {
    if (other === kind) continue;
    const until = other === FRONT ? -front : other === BACK ? -back : Math.max(front, back);
    const isSame = isCoarse(limits, other, level, bend, size, away) === answer;
    margin = Math.min(margin, isSame ? Math.max(until, MARGIN[0]!) : until);
  }
  MARGIN[0] = margin;
  return answer;
}

/** Whether a kind's limits ask for more; MARGIN says how far the eye may move before that changes. */
function isCoarse(
  limits: Float64Array,
  kind: number,
  level: number,
  bend: number,
  size: number,
  away: number,
): boolean {
  MARGIN[0] = Infinity;
  if (level >= limits[kind]! || bend < limits[kind + BEND]!) return false;
  const edge = limits[kind + EDGE]!;
  if (edge <= 0) return true;
  const far = size / edge;
  MARGIN[0] = Math.abs(far - away);
  return far > away;
}

/** Of a triangle; the squares of two of its edges are known. */
function longestEdge(at: Float64Array, uu: number, vv: number): number {
  const x = at[6]! - at[3]!;
  const y = at[7]! - at[4]!;
  const z = at[8]! - at[5]!;
  return Math.sqrt(Math.max(uu, Math.max(vv, x * x + y * y + z * z)));
}

/** A slack that rounding cannot have made too large. */
function trusted(slack: number, away: number): number {
  return 0.999 * slack - 1e-12 * away;
}
