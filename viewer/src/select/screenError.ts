/**
 * How wrong a node looks while it is not expanded: its geometric error, in pixels, from where the eye is.
 *
 * This is the whole of view dependence; `cut.ts` refines a node while this number is above the viewer's
 * tolerance and stops below it.
 *
 * - Lengths are in the asset's unit, results in pixels (device or CSS: those of `pixelsPerRadian`).
 * - Pure: same input, same output. Nothing here knows three.js, the network or time, so it runs in a worker
 *   and in a test with no browser.
 * - Conservative: distance is taken to the nearest point of the bounding sphere, so to first order no part of
 *   the node looks worse than this at the middle of the view.
 * - Allocates nothing: it runs for many nodes in every frame. Same operations in the same order as
 *   `src/foveal/lod/_kernels_select.py`, so that both give the same bits.
 *
 * Based on: P. Cignoni et al. Batched Multi Triangulation. IEEE Visualization, 2005.
 *
 * @module select/screenError
 */

/** What the eye sees, in the asset's unit relative to its origin. */
export interface View {
  /** Where the eye is. */
  readonly eye: ArrayLike<number>;
  /** `viewportHeight / (2 tan(fovY / 2))`. */
  readonly pixelsPerRadian: number;
  /** Nothing nearer than this is drawn, so no distance counts as less. */
  readonly near: number;
  /** Planes of the frustum, four numbers each, as `frustum.ts` makes them. */
  readonly planes: ArrayLike<number>;
}

/**
 * Projected error in pixels of a sphere around (x, y, z).
 *
 * @returns `Infinity` when the eye is inside the sphere, but 0 for an error of 0.
 */
export function screenError(
  error: number,
  x: number,
  y: number,
  z: number,
  radius: number,
  view: View,
): number {
  if (error <= 0) return 0;
  const dx = x - view.eye[0]!;
  const dy = y - view.eye[1]!;
  const dz = z - view.eye[2]!;
  // Not Math.hypot: it is slow, and rounds differently from engine to engine.
  const distance = Math.sqrt(dx * dx + dy * dy + dz * dz) - radius;
  if (distance <= 0) return Number.POSITIVE_INFINITY;
  return (view.pixelsPerRadian * error) / Math.max(distance, view.near);
}
