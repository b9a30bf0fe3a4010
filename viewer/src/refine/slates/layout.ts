/**
 * Catmull-Clark surfaces tessellated in the page: what its files are, and the small numbers that they share.
 *
 * It is the twin of `src/foveal/refine/slates*.py` and `_kernels_slates*.py`, and held with them to
 * golden/slates.json (spec/slates.md). Of `slates_X.py` and `_kernels_slates_X.py` together:
 *
 * | here | there |
 * | --- | --- |
 * | `topology.ts`, `firstStep.ts` | `topology`, the kernels `step` and `cage` |
 * | `masks.ts`, `ringRules.ts`, `eigen.ts` | `masks` |
 * | `net.ts`, `tables.ts` | `cage` |
 * | `ring.ts`, `sides.ts`, `patch.ts`, `rims.ts`, `limits.ts` | the kernels `ring`, `sides`, none, `rims`, `vertices` |
 * | `arena.ts`, `blocks.ts` | `arena`, `blocks` |
 * | `bends.ts`, `views.ts`, `rate.ts`, `placements.ts` | the kernel `depth`, `depth`, `rate`, `placements` |
 * | `counts.ts`, `triangles.ts`, `shown.ts` | the kernel `show`, `shown` |
 * | `slates.ts` | `slates.py` |
 *
 * A page never edits a control mesh, so nothing here moves it. A slate holds one patch where Python's holds
 * four for the sake of vectors, which JavaScript has none of. Every expression is in the same order.
 *
 * A ring is a vertex, its spokes e_0 .. and the vertices f_0 .. across its faces, x, y, z each, in the order that
 * the control mesh gives it, whichever patch looks.
 *
 * @module refine/slates/layout
 */

/** Steps at most: 65,536 quadrangles for one. */
export { MOST_DEPTH } from "../../format/cage";

/** Kinds of a control vertex: four smooth faces around it; another number; a border, a crease, a corner. */
export const REGULAR = 0;
export const SMOOTH = 1;
export const TAGGED = 2;

/** A sharpness that does not decrease. */
export const INFINITE = 10;

/** Of 16 v + 4 sum e + sum f, the limit point of a vertex of four faces. */
export const LIMIT_SHARE = 1 / 36;

/** There is no such face. */
export const NONE = -1;

/** Numbers a point of a table takes. */
export const WORDS = 3;
