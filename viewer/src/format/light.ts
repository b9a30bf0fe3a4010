/** What the file of a shadow map says of its light (spec/container.md, kind `shadow`). */
import { damaged } from "./container";
import type { Triple } from "./graph";
import type { ShadowInfo } from "./shadow";

type Told = Readonly<Record<string, unknown>>;

/** A row of a 4 x 4 matrix. */
export type Row = readonly [number, number, number, number];
/** As in spec/shadows.md: from the world to u, v, depth and W. */
export type Projection = readonly [Row, Row, Row, Row];

/** One projection, six of a point, or a stack: in order of time, or of places on an area. */
export type LightKind = "one" | "cube" | "path" | "area";

export interface LightInfo {
  readonly kind: LightKind;
  readonly projections: readonly Projection[];
  /** The map has 2^levels pixels a side. */
  readonly levels: number;
  /** Of a stack; else 1. */
  readonly images: number;
  readonly spread: number;
  /** Of an area, its middle: where it is (1 at the end), or the way to it (0). */
  readonly middle: Row | null;
  /** Of a spot, the way it looks, and the least cosine to that. */
  readonly cone: { readonly axis: Triple; readonly cosine: number } | null;
  /** What the file calls it, such as `sun`. */
  readonly name: string;
  /** ISO 8601, of sunlight. */
  readonly begin: string | null;
  readonly end: string | null;
  /** Of a path, the clock of each image, in minutes of its day. */
  readonly minutes: readonly number[] | null;
}

/** The kinds that have several projections; all others have one. */
const KINDS: Readonly<Record<string, LightKind>> = { point: "cube", sun_path: "path", area: "area" };
const CUBE_FACES = 6;

/** @throws Problem if light and projections do not hold together. */
export function lightOf(
  { light, projections, levels, children, images, spread }: ShadowInfo,
  name: string,
): LightInfo {
  const source = isObject(light.light) ? light.light : light; // of an area, what it is around
  const kind = KINDS[String(light.kind)] ?? "one";
  const isStack = kind === "path" || kind === "area";
  const isWhole =
    isStack === (children === 8) && (isStack || projections.length === (kind === "cube" ? CUBE_FACES : 1));
  if (!isWhole) throw damaged(name);
  return {
    kind,
    projections: projections.map(rowsOf),
    levels,
    images,
    spread,
    middle: kind === "area" ? middleOf(source) : null,
    cone: coneOf(source),
    name: String(light.kind),
    begin: textOf(light.time ?? light.begin),
    end: textOf(light.end),
    minutes: kind === "path" ? minutesOf(light.times, images) : null,
  };
}

function rowsOf(matrix: Float64Array): Projection {
  const row = (i: number): Row => [...matrix.subarray(4 * i, 4 * i + 4)] as unknown as Row;
  return [row(0), row(1), row(2), row(3)];
}

function textOf(value: unknown): string | null {
  return typeof value === "string" ? value : null;
}

function middleOf({ position, direction }: Told): Row | null {
  if (isTriple(position)) return [...position, 1];
  if (!isTriple(direction)) return null;
  const size = -Math.hypot(...direction);
  return [direction[0] / size, direction[1] / size, direction[2] / size, 0];
}

function coneOf({ kind, position, target, angle_degrees }: Told): LightInfo["cone"] {
  if (kind !== "spot" || !isTriple(position) || !isTriple(target)) return null;
  if (typeof angle_degrees !== "number" || !(angle_degrees > 0)) return null;
  const axis = target.map((t, a) => t - position[a]!) as unknown as Triple;
  return { axis, cosine: Math.cos((angle_degrees * Math.PI) / 360) };
}

function isObject(value: unknown): value is Told {
  return typeof value === "object" && value !== null;
}

function isTriple(value: unknown): value is Triple {
  return Array.isArray(value) && value.length === 3 && value.every((x) => Number.isFinite(x));
}

/** By the clock of the first: `2026-06-21T08:00:00+02:00` is 480. Null if they are no times in order. */
function minutesOf(times: unknown, images: number): number[] | null {
  if (!Array.isArray(times) || times.length !== images) return null;
  const clock = /T(\d\d):(\d\d)/.exec(String(times[0]));
  if (!clock) return null;
  const first = 60 * Number(clock[1]) + Number(clock[2]);
  const begin = Date.parse(String(times[0]));
  const minutes = times.map((time) => first + (Date.parse(String(time)) - begin) / 60_000);
  const isRising = minutes.every((m, i) => Number.isFinite(m) && (i === 0 || m > minutes[i - 1]!));
  return isRising ? minutes : null;
}
