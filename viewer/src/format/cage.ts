/** Header of kind `cage`: a control mesh, and how it is meant to be refined (spec/container.md). */
import { damaged, type Header } from "./container";
import type { Axis, Triple } from "./graph";
import { Problem } from "./problem";

export const CAGE = "cage";
/** Triangles, and polygons with creases. */
const TRIANGLES = 1;
const POLYGONS = 2;

export const CATMULL_CLARK = "catmull-clark";
export const SCHEMES = ["sqrt3", "loop", "butterfly", CATMULL_CLARK] as const;
export type Scheme = (typeof SCHEMES)[number];

export const POSITIONS = ["control", "limit"] as const;
export type Positions = (typeof POSITIONS)[number];

/** When a triangle is fine enough; keys as on the wire. */
export interface RegionLimits {
  /** Never finer than this level. */
  readonly iterations: number;
  /** Its edges have at most so many pixels; 0 for no such limit. */
  readonly edge_px: number;
  /** Radians that it may bend away from the limit surface; 0 for no such limit. */
  readonly bend: number;
}

export const REGIONS = ["front", "silhouette", "back"] as const;
export type Criteria = Readonly<Record<(typeof REGIONS)[number], RegionLimits>>;

/** By which rules Catmull-Clark patches get their depth; keys as in files and on the wire. */
export interface DepthRules {
  readonly most: number;
  /** Null to leave out what the surface bends. */
  readonly cone_degrees: number | null;
  readonly backs: boolean;
  readonly silhouettes: boolean;
  readonly epsilon: number;
  /** Least and greatest radius of a piece of a patch; null to leave out how large it looks. */
  readonly size_px: readonly [number, number] | null;
}

/** How a control mesh is refined. */
export interface Refinement {
  readonly scheme: Scheme;
  /** They say nothing of `catmull-clark`, which has `depths`. */
  readonly criteria: Criteria;
  readonly depths: DepthRules;
  readonly positions: Positions;
  /** Triangles at most, 0 for no limit. */
  readonly budget: number;
  /** Frames a second to hold, 0 for no such wish. */
  readonly rate: number;
}

/** What a `.fov` of kind `cage` says of itself. */
export interface CageInfo {
  /** What refined positions are relative to: the middle of the box. */
  readonly origin: Triple;
  /** Least and greatest corner. */
  readonly box: readonly [Triple, Triple];
  readonly up: Axis;
  /** In all places. */
  readonly triangles: number;
  readonly vertices: number;
  /** Two vertices each of the edges that stay sharp. */
  readonly sharpEdges: readonly number[];
  /** How many are shown, in all places; in a file of polygons. */
  readonly polygons: number | undefined;
  /** How often these stand, if not once and where they are. */
  readonly placements: number | undefined;
  readonly refinement: Refinement;
}

export const MOST_DEPTH = 8;

export const USUAL_DEPTHS: DepthRules = {
  most: 5,
  cone_degrees: 8,
  backs: true,
  silhouettes: true,
  epsilon: 0.1,
  size_px: [3, 24],
};

const INITIAL: Refinement = {
  scheme: "sqrt3",
  criteria: {
    front: { iterations: 4, edge_px: 8, bend: 0 },
    silhouette: { iterations: 6, edge_px: 4, bend: 0 },
    back: { iterations: 0, edge_px: 0, bend: 0 },
  },
  depths: USUAL_DEPTHS,
  positions: "control",
  budget: 0,
  rate: 0,
};

/** @throws Problem if the version is not known, or a value that is needed makes no sense. */
export function parseCage(header: Header, name: string): CageInfo {
  const hasPolygons = header.version === POLYGONS;
  if (header.version !== TRIANGLES && !hasPolygons) {
    const known = `${TRIANGLES} and ${POLYGONS}`;
    throw new Problem(
      "version",
      `${name} has version ${String(header.version)} of kind "${CAGE}"; this viewer knows version ${known}. Update foveal, or build the file again.`,
    );
  }
  const { origin, box, up, triangles, vertices, sharp_edges: sharpEdges = [] } = header;
  const isBox = Array.isArray(box) && box.length === 2 && box.every(isTriple);
  if (!isTriple(origin) || !isBox || !isCount(triangles) || !isCount(vertices)) throw damaged(name);
  if (!areEdges(sharpEdges, vertices)) throw damaged(name);
  const { faces, holes = 0, placements } = hasPolygons ? header : {};
  const isPlaced = placements !== undefined;
  if (hasPolygons && !(isCount(faces) && Number(holes) < faces)) throw damaged(name);
  if (isPlaced && !isCount(placements)) throw damaged(name);
  const times = isPlaced ? placements : 1;
  return {
    origin,
    box: box as unknown as [Triple, Triple],
    up: up === "x" || up === "z" ? up : "y",
    triangles: times * triangles,
    vertices,
    sharpEdges,
    polygons: hasPolygons ? times * ((faces as number) - Number(holes)) : undefined,
    placements,
    refinement: refinementOf(header, name),
  };
}

/**
 * How a layer of scene.json, or a header, says it is refined; what it does not say is as in `base`.
 *
 * @throws Problem if the scheme is not known; a number that makes no sense is as in `base`.
 */
export function refinementOf(data: Header, name: string, base: Refinement = INITIAL): Refinement {
  const scheme = data.scheme === undefined ? base.scheme : SCHEMES.find((known) => known === data.scheme);
  if (!scheme) {
    const names = SCHEMES.join(", ");
    throw new Problem(
      "version",
      `${name} is refined by "${String(data.scheme)}"; this viewer knows ${names}. Update foveal.`,
    );
  }
  const criteria = isObject(data.criteria) ? data.criteria : {};
  return {
    scheme,
    criteria: {
      front: limitsOf(criteria.front, base.criteria.front),
      silhouette: limitsOf(criteria.silhouette, base.criteria.silhouette),
      back: limitsOf(criteria.back, base.criteria.back),
    },
    depths: depthsOf(data.depths, base.depths),
    positions: POSITIONS.find((known) => known === data.positions) ?? base.positions,
    budget: within(data.budget, 0, 2 ** 32 - 1) ?? base.budget,
    rate: within(data.rate, 0, 1000) ?? base.rate,
  };
}

function limitsOf(data: unknown, base: RegionLimits): RegionLimits {
  if (!isObject(data)) return base;
  const degrees = within(data.bend_degrees, 0, 180);
  return {
    iterations: Math.round(within(data.iterations, 0, 30) ?? base.iterations),
    edge_px: within(data.edge_px, 0, 1e6) ?? base.edge_px,
    bend: degrees === null ? base.bend : (degrees * Math.PI) / 180,
  };
}

function depthsOf(data: unknown, base: DepthRules): DepthRules {
  if (!isObject(data)) return base;
  const isSwitch = (value: unknown, own: boolean): boolean => (typeof value === "boolean" ? value : own);
  const { cone_degrees: cone, size_px: size } = data;
  return {
    most: Math.round(within(data.most, 0, MOST_DEPTH) ?? base.most),
    cone_degrees: cone === null ? null : (within(cone, 0, 180) ?? base.cone_degrees),
    backs: isSwitch(data.backs, base.backs),
    silhouettes: isSwitch(data.silhouettes, base.silhouettes),
    epsilon: within(data.epsilon, 0, 1) ?? base.epsilon,
    size_px: size === null ? null : isRange(size) ? size : base.size_px,
  };
}

/** Two radii, of which the second is twice the first, at least. */
function isRange(value: unknown): value is [number, number] {
  if (!Array.isArray(value) || value.length !== 2) return false;
  const [least, most] = value.map((radius) => within(radius, 0, 1e9));
  return typeof least === "number" && typeof most === "number" && 2 * least <= most;
}

function within(value: unknown, low: number, high: number): number | null {
  return typeof value === "number" && value >= low && value <= high ? value : null;
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}

function isCount(value: unknown): value is number {
  return Number.isInteger(value) && (value as number) >= 1;
}

function areEdges(value: unknown, vertices: number): value is number[] {
  const isVertex = (v: unknown) => Number.isInteger(v) && (v as number) >= 0 && (v as number) < vertices;
  return Array.isArray(value) && value.length % 2 === 0 && value.every(isVertex);
}

function isTriple(value: unknown): value is Triple {
  return Array.isArray(value) && value.length === 3 && value.every((x) => Number.isFinite(x));
}
