/** The tree of a shadow map as words for look-ups (spec/shadows.md, "The tree in memory"). */
import { Problem } from "./problem";
import { INNER, type Tree } from "./shadowTree";

const MOST_POINTER = (1 << 16) - 1;
const TRIALS = 16; // scales tried for the least padding
const MOST_WORDS = 2 ** 32;

export interface Packed {
  readonly words: Uint32Array;
  /** Words that a pointer of one means, by the level of the node that has it. */
  readonly scales: readonly number[];
  readonly levels: number;
  readonly children: number;
  readonly root: number;
}

/** @throws Problem if the tree is too large for its pointers. */
export function pack(tree: Tree, name: string): Packed {
  const { levels, children, root } = tree;
  const scales: number[] = new Array(levels).fill(1);
  if (root !== INNER) return { words: tree.values.slice(), scales, levels, children, root };
  const extents: Float64Array[] = [];
  extents[levels] = new Float64Array(0);
  for (let level = levels - 1; level >= 0; level--) {
    const masks = masksOf(tree, level);
    const own = new Float64Array(masks.length);
    const scale = bestScale(masks, extents[level + 1]!, own, name);
    extents[level] = own;
    if (level + 1 < levels) scales[level + 1] = scale;
  }
  const count = 2 + extents[0]![0]!;
  if (count >= MOST_WORDS) throw tooLarge(name);
  const words = new Uint32Array(count);
  words[1] = tree.values[0]!;
  let places: Places = { links: Float64Array.of(0), blocks: Float64Array.of(2) };
  for (let level = 0; level < levels; level++) {
    places = write(tree, level, places, scales, extents[level + 1]!, words);
  }
  return { words, scales, levels, children, root };
}

/** Where the words and the children's block of each node with children of one level begin. */
interface Places {
  readonly links: Float64Array;
  readonly blocks: Float64Array;
}

function masksOf(tree: Tree, level: number): Uint16Array {
  return tree.masks.subarray(tree.maskStarts[level], tree.maskStarts[level + 1]);
}

/** Words of a block of children: one for a leaf or an empty node, two for an inner one. */
function blockWords(mask: number): number {
  let count = 0;
  for (let rest = mask; rest; rest &= rest - 1) count++;
  return count;
}

/** Words to skip so that a distance is whole times the scale. */
function padding(distance: number, scale: number): number {
  return (scale - (distance % scale)) % scale;
}

/** The scale of the level below, by which `extents` are laid out. */
function bestScale(masks: Uint16Array, below: Float64Array, extents: Float64Array, name: string): number {
  const { longest } = lay(masks, below, 1, extents);
  if (longest <= MOST_POINTER) return 1;
  const first = Math.ceil(longest / MOST_POINTER);
  let best = 0;
  let least = Number.POSITIVE_INFINITY;
  for (let scale = first; scale < first + TRIALS; scale++) {
    const laid = lay(masks, below, scale, extents);
    if (laid.longest <= MOST_POINTER * scale && laid.padding < least) {
      best = scale;
      least = laid.padding;
    }
  }
  if (best === 0) throw tooLarge(name);
  lay(masks, below, best, extents);
  return best;
}

/** Fill in how many words lie from the block of each node on; the longest way from a link to its block. */
function lay(
  masks: Uint16Array,
  below: Float64Array,
  scale: number,
  extents: Float64Array,
): { longest: number; padding: number } {
  let longest = 0;
  let padded = 0;
  let child = 0;
  for (let node = 0; node < masks.length; node++) {
    const mask = masks[node]!;
    let link = 0;
    let free = blockWords(mask);
    for (let rest = mask; rest; rest >>= 2) {
      const kind = rest & 3;
      if (kind >= 2) {
        const pad = padding(free - link, scale);
        padded += pad;
        longest = Math.max(longest, free + pad - link);
        free += pad + below[child++]!;
      }
      link += (kind & 1) + (kind >> 1);
    }
    extents[node] = free;
  }
  return { longest, padding: padded };
}

/** Write the links of one level's nodes and the values of their children; where those with children are. */
function write(
  tree: Tree,
  level: number,
  { links, blocks }: Places,
  scales: readonly number[],
  below: Float64Array,
  words: Uint32Array,
): Places {
  const masks = masksOf(tree, level);
  const scaleBelow = scales[level + 1] ?? 1;
  const places = { links: new Float64Array(below.length), blocks: new Float64Array(below.length) };
  let child = 0;
  let value = tree.valueStarts[level + 1]!;
  for (let node = 0; node < masks.length; node++) {
    const mask = masks[node]!;
    let link = blocks[node]!;
    let free = link + blockWords(mask);
    words[links[node]!] = mask | (((link - links[node]!) / scales[level]!) << 16);
    for (let rest = mask; rest; rest >>= 2) {
      const kind = rest & 3;
      if (kind & 1) words[link + (kind >> 1)] = tree.values[value++]!;
      if (kind >= 2) {
        free += padding(free - link, scaleBelow);
        places.links[child] = link;
        places.blocks[child] = free;
        free += below[child++]!;
      }
      link += (kind & 1) + (kind >> 1);
    }
  }
  return places;
}

function tooLarge(name: string): Problem {
  return new Problem("damaged", `${name} is too large to be looked up. Build it at a lower resolution.`);
}
