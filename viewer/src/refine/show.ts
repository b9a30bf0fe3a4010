/**
 * What is shown of a √3 refinement, slot by slot.
 *
 * The same as `src/foveal/refine/_kernels_sqrt3_show.py`.
 *
 * @module refine/show
 */
import { measure } from "./measure";
import { BORDER, FREE, generation, LIMIT, type Net, NONE, POINT, THIRD_VECTOR, UNMEASURED } from "./net";
import { position } from "./points";

/** Faces and vertices in slots; what did not change since the last time is where it was. */
export interface Shown {
  /** Three vertices a slot; (0, 0, 0) where it is free. */
  readonly faces: Uint32Array;
  /** Of a face slot: how often it was refined. */
  readonly levels: Uint8Array;
  /** Of a vertex: the highest level of its faces. */
  readonly highest: Int8Array;
}

export function showFaces(net: Net): Shown {
  const { faceSlots, vertexSlots, corners, states } = net;
  const faces = new Uint32Array(3 * faceSlots);
  const levels = new Uint8Array(faceSlots);
  const highest = net.births.slice(0, vertexSlots);
  for (let f = 0; f < faceSlots; f++) {
    if (states[f] === FREE) continue;
    const level = generation(states[f]!);
    levels[f] = level;
    for (let i = 3 * f; i < 3 * f + 3; i++) {
      const v = corners[i]!;
      faces[i] = v;
      if (highest[v]! < level) highest[v] = level;
    }
  }
  return { faces, levels, highest };
}

/**
 * Write where vertex v is: on the highest level of its faces, or in the limit. At a seam of the faces on both sides,
 * which may have come to different levels.
 */
export function showVertex(
  net: Net,
  v: number,
  isLimit: boolean,
  highest: Int8Array,
  out: Float64Array,
  at: number,
): void {
  if (net.births[v] === FREE) for (let k = 0; k < 3; k++) out[at + k] = net.points[POINT * v + k]!;
  else if (isLimit) limit(net, v, out, at);
  else {
    const twin = net.twins[v]!;
    position(net, v, twin === NONE ? highest[v]! : Math.max(highest[v]!, highest[twin]!), out, at);
  }
}

/** Where vertex v goes. It is measured if need be: then none of its faces is finer than itself. */
function limit(net: Net, v: number, out: Float64Array, at: number): void {
  if (net.kinds[v] === UNMEASURED) measure(net, v);
  const { points } = net;
  const p = POINT * v;
  const isBorder = net.kinds[v] === BORDER;
  for (let k = 0; k < 3; k++) {
    out[at + k] = isBorder ? points[p + k]! + points[p + THIRD_VECTOR + k]! / 6 : points[p + LIMIT + k]!;
  }
}
