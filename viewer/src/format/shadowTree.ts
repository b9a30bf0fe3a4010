/** The tree of a shadow map, level by level, as `foveal.shadows.tree`. */

export const LEAF = 1;
export const INNER = 3;
export const MOST_LEVELS = 24;

/** The last value on the way down to a pixel holds there; a receiver at a step of at most that is lit. */
export interface Tree {
  /** 2^levels pixels a side; the root is level 0. */
  readonly levels: number;
  /** 4, or 8 of a stack of images. */
  readonly children: number;
  /** LEAF or INNER. */
  readonly root: number;
  /** Of nodes with children, by levels: two bits a child, its kind. */
  readonly masks: Uint16Array;
  /** Masks of level l are maskStarts[l] .. maskStarts[l + 1] - 1. */
  readonly maskStarts: readonly number[];
  /** Of nodes with a value, by levels, in the order of their parents. */
  readonly values: Uint32Array;
  readonly valueStarts: readonly number[];
}

/** What a decoder is told of a tree: nodes with children, and with a value, on each level. */
export interface Counts {
  readonly levels: number;
  readonly children: number;
  readonly root: number;
  readonly masks: readonly number[];
  readonly values: readonly number[];
}

/** Whether any tree has so many. */
export function isPossible({ levels, children, root, masks, values }: Counts): boolean {
  if (levels > MOST_LEVELS || (children !== 4 && children !== 8) || (root !== LEAF && root !== INNER))
    return false;
  if (masks.length !== levels || values.length !== levels + 1 || values[0] !== 1) return false;
  if (levels > 0 ? masks[0] !== Number(root === INNER) : root === INNER) return false;
  return masks.every(
    (nodes, level) =>
      values[level + 1]! <= children * nodes &&
      (level === levels - 1 || masks[level + 1]! <= children * nodes),
  );
}

/** A tree by its levels; `masks` are one less than `values`. */
export function treeOf(
  children: number,
  root: number,
  masks: readonly Uint16Array[],
  values: readonly Uint32Array[],
): Tree {
  const maskStarts = startsOf(masks);
  const valueStarts = startsOf(values);
  const allMasks = new Uint16Array(maskStarts[masks.length]!);
  const allValues = new Uint32Array(valueStarts[values.length]!);
  masks.forEach((level, i) => {
    allMasks.set(level, maskStarts[i]);
  });
  values.forEach((level, i) => {
    allValues.set(level, valueStarts[i]);
  });
  return {
    levels: masks.length,
    children,
    root,
    masks: allMasks,
    maskStarts,
    values: allValues,
    valueStarts,
  };
}

function startsOf(levels: readonly { readonly length: number }[]): number[] {
  const starts = [0];
  for (const level of levels) starts.push(starts[starts.length - 1]! + level.length);
  return starts;
}

/**
 * Masks that end where they still tell of children below: these are left out. A mask that is 0 then goes, and what it
 * was a mask of is a leaf or nothing.
 */
export function withoutDeeper(masks: readonly Uint16Array[], children: number): Uint16Array[] {
  const kept: Uint16Array[] = [];
  let below: Uint16Array | null = null; // the level below, before masks of 0 have gone
  for (let level = masks.length - 1; level >= 0; level--) {
    const cut = masks[level]!.slice();
    let next = 0;
    for (let node = 0; node < cut.length; node++) {
      for (let child = 0; child < children; child++) {
        const split = 2 << (2 * child);
        if (!(cut[node]! & split)) continue;
        if (!below || below[next] === 0) cut[node]! &= ~split;
        next++;
      }
    }
    below = cut;
    kept[level] = cut.filter((mask) => mask !== 0);
  }
  return kept;
}
