/**
 * What the camera can see at all: bounding spheres against the planes of its frustum.
 *
 * - Planes are four numbers each, (normal, offset), normals unit and inward: a point x is inside where
 *   `normal . x + offset >= 0`. Near, left, right, bottom, top; what is far is small and needs no plane.
 * - Lengths are in the asset's unit, relative to its origin.
 * - Conservative: a sphere counts as seen unless one plane has all of it outside.
 * - Pure, allocates nothing, knows nothing but numbers. The same as `src/foveal/view/camera.py`.
 *
 * @module select/frustum
 */

export const FRUSTUM_PLANES = 5;

type Vector = readonly [x: number, y: number, z: number];

/**
 * Write the planes of a perspective camera into `planes` (20 numbers).
 *
 * @param eye where the camera is
 * @param right, up, backward its axes: orthogonal unit vectors; it looks along minus `backward`
 * @param tanX, tanY tangents of half the horizontal and half the vertical field of view
 * @param near distance of the near plane
 */
export function setFrustum(
  planes: Float64Array,
  eye: Vector,
  right: Vector,
  up: Vector,
  backward: Vector,
  tanX: number,
  tanY: number,
  near: number,
): void {
  setPlane(planes, 0, eye, right, 0, backward, -1);
  setPlane(planes, 1, eye, right, 1, backward, -tanX);
  setPlane(planes, 2, eye, right, -1, backward, -tanX);
  setPlane(planes, 3, eye, up, 1, backward, -tanY);
  setPlane(planes, 4, eye, up, -1, backward, -tanY);
  planes[3] = planes[3]! - near;
}

/** The plane through the eye whose normal is `a * alongA + b * alongB`, made unit; a and b are orthogonal. */
function setPlane(
  planes: Float64Array,
  plane: number,
  eye: Vector,
  a: Vector,
  alongA: number,
  b: Vector,
  alongB: number,
): void {
  const length = Math.sqrt(alongA * alongA + alongB * alongB);
  const x = (alongA * a[0] + alongB * b[0]) / length;
  const y = (alongA * a[1] + alongB * b[1]) / length;
  const z = (alongA * a[2] + alongB * b[2]) / length;
  planes[4 * plane] = x;
  planes[4 * plane + 1] = y;
  planes[4 * plane + 2] = z;
  planes[4 * plane + 3] = -(x * eye[0] + y * eye[1] + z * eye[2]);
}

/** Whether a sphere may be seen. */
export function sphereInFrustum(
  planes: ArrayLike<number>,
  x: number,
  y: number,
  z: number,
  radius: number,
): boolean {
  for (let at = 0; at < planes.length; at += 4) {
    const side = planes[at]! * x + planes[at + 1]! * y;
    if (side + planes[at + 2]! * z + planes[at + 3]! < -radius) return false;
  }
  return true;
}
