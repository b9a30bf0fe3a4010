/**
 * The tree of a shadow map, looked up: what `scene/light/lookup.glsl` does for every pixel, as one can read it.
 *
 * - Pixels and images are whole numbers from 0, depths and values u32 steps; a receiver is lit where step <= value.
 * - Every level is a map of its own: pixel (x, y) of level l holds for the square of pixels below it.
 * - A kernel goes down once, to the last node that all its samples share, and each sample goes on from there.
 *
 * Both are held to `spec/golden/shadow_lookup.json`.
 *
 * Based on: Scandolo, Bauszat, Eisemann. Compressed Multiresolution Hierarchies for High-Quality Precomputed
 * Shadows. Computer Graphics Forum 2016, section 3.3.
 *
 * @module select/shadowTree
 */

import type { Packed } from "../format/shadowPack";

/** A pixel of the map, and of a stack its image, in voxels of the level that is looked up. */
export type Place = readonly [x: number, y: number, image: number];

const [LEAF, EMPTY, INNER] = [1, 2, 3];

/** A node on the way down: its kind, the address of its link, and that of the last value on the way. */
interface Node {
  kind: number;
  link: number;
  held: number;
  level: number;
}

/** The value of a pixel of the map that this level is, by default the finest. */
export function valueAt(tree: Packed, place: Place, level = tree.levels): number {
  const node = rootOf(tree);
  descend(tree, node, scaled(tree, place, level), 0, level);
  return tree.words[node.held]!;
}

/**
 * How many of the (2 r + 1)² pixels around one are lit for a receiver at this step; off the map all is lit.
 *
 * @param level - Of the map that `place` counts the pixels of, by default the finest.
 */
export function countLit(
  tree: Packed,
  [x, y, image]: Place,
  step: number,
  radius: number,
  level = tree.levels,
): number {
  const last = 2 ** level - 1;
  const [x0, x1] = [Math.max(0, x - radius), Math.min(last, x + radius)];
  const [y0, y1] = [Math.max(0, y - radius), Math.min(last, y + radius)];
  const all = (2 * radius + 1) ** 2;
  const area = Math.max(0, x1 - x0 + 1) * Math.max(0, y1 - y0 + 1);
  if (area === 0) return all;
  const common = rootOf(tree);
  const differing = ((x0 ^ x1) | (y0 ^ y1)) << (tree.levels - level);
  descend(tree, common, scaled(tree, [x0, y0, image], level), differing, level);
  if (common.kind < EMPTY || common.level === level) {
    return step <= tree.words[common.held]! ? all : all - area;
  }
  let lit = all - area;
  for (let sy = y0; sy <= y1; sy++) {
    for (let sx = x0; sx <= x1; sx++) {
      const node = { ...common };
      descend(tree, node, scaled(tree, [sx, sy, image], level), 0, level);
      if (step <= tree.words[node.held]!) lit++;
    }
  }
  return lit;
}

function rootOf({ root }: Packed): Node {
  return { kind: root, link: 0, held: root === INNER ? 1 : 0, level: 0 };
}

/** The same place in voxels of the finest level. */
function scaled({ levels }: Packed, [x, y, image]: Place, level: number): Place {
  const shift = levels - level;
  return [x << shift, y << shift, image << shift];
}

/** Go down to `last`, to the end, or to where the bits in `differing` begin. */
function descend(tree: Packed, node: Node, [x, y, z]: Place, differing: number, last: number): void {
  while (node.kind >= EMPTY && node.level < last) {
    const bit = tree.levels - 1 - node.level;
    if (differing >> bit !== 0) return;
    const link = tree.words[node.link]!;
    const child = ((x >> bit) & 1) | (((y >> bit) & 1) << 1) | (((z >> bit) & 1) << 2);
    const before = ones(link & ((1 << (2 * child)) - 1));
    const address = node.link + (link >>> 16) * tree.scales[node.level]! + before;
    node.kind = (link >> (2 * child)) & 3;
    if (node.kind & LEAF) node.held = address + (node.kind === INNER ? 1 : 0);
    node.link = address;
    node.level++;
  }
}

/** Bits set in a word of 16. */
function ones(word: number): number {
  const pairs = word - ((word >> 1) & 0x5555);
  const fours = (pairs & 0x3333) + ((pairs >> 2) & 0x3333);
  const eights = (fours + (fours >> 4)) & 0x0f0f;
  return (eights + (eights >> 8)) & 31;
}
