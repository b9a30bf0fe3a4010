/** Trees of a shadow map as the GPU takes them: one after the other in rows of a texture of words. */

import type { Packed } from "../format/shadowPack";

/** Trees at most: those of a point light. */
export const MOST_TREES = 6;
/** Levels at most, and so scales of a tree. */
export const MOST_LEVELS = 20;
/** Rows are at least so wide: 2^6 words. */
const LEAST_WIDTH_BITS = 6;

/** A shadow map that is complete down to a level. */
export interface ShadowStage {
  /** Word a is in column a mod 2^widthBits of row a / 2^widthBits; whole rows. */
  readonly words: Uint32Array<ArrayBuffer>;
  readonly widthBits: number;
  readonly levels: number;
  /** Of each tree the address of its root and the root's kind. */
  readonly roots: Uint32Array<ArrayBuffer>;
  /** MOST_LEVELS a tree. */
  readonly scales: Uint32Array<ArrayBuffer>;
}

export function stageOf(trees: readonly Packed[]): ShadowStage {
  const count = trees.reduce((sum, { words }) => sum + words.length, 0);
  let widthBits = LEAST_WIDTH_BITS;
  while (4 ** widthBits < count) widthBits++;
  const width = 2 ** widthBits;
  const words = new Uint32Array(width * Math.max(1, Math.ceil(count / width)));
  const roots = new Uint32Array(2 * MOST_TREES);
  const scales = new Uint32Array(MOST_LEVELS * MOST_TREES);
  let at = 0;
  trees.forEach((tree, i) => {
    words.set(tree.words, at);
    roots.set([at, tree.root], 2 * i);
    scales.set(Array.from(tree.scales).slice(0, MOST_LEVELS), MOST_LEVELS * i);
    at += tree.words.length;
  });
  return { words, widthBits, levels: trees[0]!.levels, roots, scales };
}
