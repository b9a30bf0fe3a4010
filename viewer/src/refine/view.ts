/**
 * What a refinement is asked for, as the numbers that it reads.
 *
 * From these numbers on, the page and Python compute the same to the last bit. How they come from a camera or an
 * angle leans on tangents and cosines, which agree to some 1e-15 only (spec/refinement.md).
 *
 * @module refine/view
 */
import { type Criteria, REGIONS } from "../format/cage";
import type { Triple } from "../format/graph";
import { setFrustum } from "../select/frustum";
import type { WireCamera } from "../stream/refinement";

/** The eye, pixels per radian, and the planes near, left, right, bottom and top as (normal, offset): 24 numbers. */
export function viewOf({ position, target, up, fov, width, height, near }: WireCamera): Float64Array {
  const view = new Float64Array(24);
  const backward = unit([position[0] - target[0], position[1] - target[1], position[2] - target[2]]);
  const right = unit(cross(up, backward));
  const tanY = Math.tan(fov / 2);
  view.set(position);
  view[3] = height / (2 * tanY);
  const planes = view.subarray(4);
  setFrustum(planes, position, right, cross(backward, right), backward, (tanY * width) / height, tanY, near);
  return view;
}

/** For front faces, silhouettes and back faces: iterations, pixels of an edge, 1 - cosine of the bend: 9 numbers. */
export function limitsOf(criteria: Criteria): Float64Array {
  const limits = new Float64Array(9);
  REGIONS.forEach((name, i) => {
    const { iterations, edge_px, bend } = criteria[name];
    limits.set([iterations, edge_px, 1 - Math.cos(bend)], 3 * i);
  });
  return limits;
}

function cross(a: Triple, b: Triple): Triple {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit([x, y, z]: Triple): Triple {
  const length = Math.sqrt(x * x + y * y + z * z);
  return [x / length, y / length, z / length];
}
