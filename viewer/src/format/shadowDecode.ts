/** The coded tree (spec/shadows.md), read chunk by chunk; whatever the bytes are, nothing worse than null comes. */
import { BitReader, Chances, MOST_BITS_A_BYTE } from "./shadowBits";
import { type Counts, INNER, isPossible, LEAF, type Tree, treeOf, withoutDeeper } from "./shadowTree";

const FAR = 0xffffffff;

// Where the contexts of each kind of decision begin.
const SPLIT = 0;
const HAS = SPLIT + (1 << 14);
const SAME = HAS + (1 << 15);
const IS_FAR = SAME + (1 << 7);
const BIT = IS_FAR + 4;
const LOST = BIT + 9 * 16;
const STOP = LOST + 8;
const CONTEXTS = STOP + 8 * 8 * 16;

/** Nodes with children of one level, and what is beside them. A cell is a child: node * children + child. */
interface Level {
  readonly masks: Uint16Array;
  readonly held: Uint32Array;
  readonly isInner: Uint8Array;
  /** The last value on the way to each cell, as known. */
  readonly cells: Uint32Array;
  /** By node and side: which node of the level is there, -1 where none is; and the value there where none is. */
  readonly links: Int32Array;
  readonly outer: Uint32Array;
}

/** Reads one tree; chunks come in their order. */
export class TreeReader {
  private readonly chances = new Chances(CONTEXTS);
  private readonly masks: Uint16Array[] = [];
  private readonly values: Uint32Array[] = [];
  private readonly dims: number;
  private readonly known: Float64Array;
  private level: Level | null = null;
  private bits = new BitReader(new Uint8Array(0), this.chances);

  /** @param parts - Levels with which chunks end, ascending. */
  constructor(
    private readonly counts: Counts,
    private readonly parts: readonly number[],
  ) {
    this.dims = counts.children === 8 ? 3 : 2;
    this.known = new Float64Array(2 * this.dims);
  }

  /** Read one more chunk. False if it is damaged: then this reader has no more use. */
  push(chunk: Uint8Array): boolean {
    const { counts } = this;
    const begin = this.values.length;
    const end = this.parts.find((part) => part >= begin);
    if (end === undefined || !isPossible(counts)) return false;
    let nodes = 0;
    for (let stage = Math.max(begin, 1); stage <= end; stage++) nodes += counts.masks[stage - 1]!;
    if (nodes * counts.children > MOST_BITS_A_BYTE * chunk.length) return false;
    this.bits = new BitReader(chunk, this.chances);
    for (let stage = begin; stage <= end; stage++) {
      if (!(stage === 0 ? this.readRoot() : this.readLevel(stage))) return false;
    }
    return this.bits.isAtEnd;
  }

  /** The tree of all chunks so far, of which there is one at least: of fewer levels until all are there. */
  tree(): Tree {
    const { children, root, levels } = this.counts;
    if (this.masks.length === levels) return treeOf(children, root, this.masks, this.values);
    const masks = withoutDeeper(this.masks, children);
    return treeOf(children, masks[0]?.length ? INNER : LEAF, masks, this.values);
  }

  private readRoot(): boolean {
    const value = this.readValue(FAR, 0, Number(this.counts.root === INNER));
    this.values.push(Uint32Array.of(value));
    return true;
  }

  private readLevel(stage: number): boolean {
    const level = this.descend(this.counts.masks[stage - 1]!);
    if (!level) return false;
    const values = new Uint32Array(this.counts.values[stage]!);
    const isLast = stage === this.counts.levels;
    let at = 0;
    for (let node = 0; node < level.masks.length; node++) {
      at = this.readNode(level, node, values, at, isLast);
      if (at < 0 || this.bits.isPastEnd) return false;
    }
    this.level = level;
    this.masks.push(level.masks);
    this.values.push(values);
    return at === values.length;
  }

  /** The mask of a node and the values of its children; how many values there are then, -1 if it is damaged. */
  private readNode(level: Level, node: number, values: Uint32Array, begin: number, isLast: boolean): number {
    const { bits, dims } = this;
    const held = level.held[node]!;
    const nodeContext = (Number(isLast) * 2 + level.isInner[node]!) << 12;
    let at = begin;
    let mask = 0;
    let history = 0;
    for (let child = 0; child < 1 << dims; child++) {
      const others = this.lookRound(level, node, child, held);
      const context = nodeContext | (child << 9) | ((history & 63) << 3) | others;
      const isSplit = isLast ? 0 : bits.bit(SPLIT + context);
      const has = bits.bit(HAS + ((context << 1) | isSplit));
      const kind = (isSplit << 1) | has;
      history = (history << 2) | kind;
      mask |= kind << (2 * child);
      if (!has) continue;
      if (at === values.length) return -1;
      const value = this.readValue(held, 2 * dims, isSplit);
      values[at++] = value;
      level.cells[(node << dims) + child] = value;
    }
    level.masks[node] = mask;
    return mask === 0 ? -1 : at;
  }

  /** The values beyond each side of a cell, as far as they are known; how many are not `held`. */
  private lookRound(level: Level, node: number, child: number, held: number): number {
    const { dims, known } = this;
    let others = 0;
    for (let side = 0; side < 2 * dims; side++) {
      const axis = side < dims ? side : side - dims;
      const isInside = ((child >> axis) & 1) !== Number(side >= dims);
      const at = isInside ? node : level.links[2 * dims * node + side]!;
      const value =
        at >= 0 ? level.cells[(at << dims) + (child ^ (1 << axis))]! : level.outer[2 * dims * node + side]!;
      known[side] = value;
      if (value !== held) others++;
    }
    return others;
  }

  /** A value where `held` held before: that of a side, or its bits. */
  private readValue(held: number, sides: number, isSplit: number): number {
    const { bits, known } = this;
    let first = held;
    let second = held;
    let found = 0;
    for (let side = 0; side < sides; side++) {
      const guess = known[side]!;
      if (guess === held || isBefore(known, side, guess)) continue;
      let times = 1;
      for (let after = side + 1; after < sides; after++) if (known[after] === guess) times++;
      if (bits.bit(SAME + ((((found << 3) | times) << 1) | isSplit))) return guess;
      if (found === 0) first = guess;
      else if (found === 1) second = guess;
      found++;
    }
    if (bits.bit(IS_FAR + (Number(held === FAR) * 2 + isSplit))) return FAR;
    return this.readBits(first + 1, second + 1) - 1;
  }

  /** A number from 1 to 2^32 - 1, with two guesses of it, to 2^32: its bits from the highest to the last 1. */
  private readBits(first: number, second: number): number {
    const { bits } = this;
    let read = 0;
    let lostFirst = 0; // how many bits ago a guess was wrong, 0 while it is not
    let lostSecond = 0;
    for (let place = 31; place >= 0; place--) {
      const depth = Math.min(31 - place, 15);
      const ofFirst = (first >>> place) & 1;
      const ofSecond = (second >>> place) & 1;
      const lost = Math.min(lostFirst, lostSecond, 7);
      const a = lostFirst === 0 ? 1 + ofFirst : 0;
      const b = lostSecond === 0 ? 1 + ofSecond : 0;
      const bit = bits.bit(lost === 0 ? BIT + 16 * (3 * a + b) + depth : LOST + lost);
      if (lostFirst > 0 || bit !== ofFirst) lostFirst++;
      if (lostSecond > 0 || bit !== ofSecond) lostSecond++;
      if (!bit) continue;
      read |= 1 << place;
      const least = Math.min(lostFirst, lostSecond, 7);
      const most = Math.min(Math.max(lostFirst, lostSecond), 7);
      if (bits.bit(STOP + 16 * (8 * least + most) + depth)) break;
    }
    return Math.max(read >>> 0, 1);
  }

  /** The level under the one before, of so many nodes; null if it has not so many. */
  private descend(nodes: number): Level | null {
    const { dims, level } = this;
    const value = this.values[0]![0]!;
    const below: Level = {
      masks: new Uint16Array(nodes),
      held: new Uint32Array(nodes).fill(value),
      isInner: new Uint8Array(nodes).fill(1),
      cells: new Uint32Array(nodes << dims).fill(value),
      links: new Int32Array(2 * dims * nodes).fill(-1),
      outer: new Uint32Array(2 * dims * nodes).fill(value),
    };
    if (!level) return below;
    const numbers = numbersOf(level.masks, dims);
    if (numbers.count !== nodes) return null;
    for (let cell = 0; cell < numbers.of.length; cell++) {
      if (numbers.of[cell]! >= 0) inherit(level, numbers.of, cell, dims, below);
    }
    return below;
  }
}

function isBefore(known: Float64Array, side: number, guess: number): boolean {
  for (let before = 0; before < side; before++) if (known[before] === guess) return true;
  return false;
}

/** Which node of the next level each cell is, -1 where it has no children. */
function numbersOf(masks: Uint16Array, dims: number): { of: Int32Array; count: number } {
  const of = new Int32Array(masks.length << dims).fill(-1);
  let count = 0;
  for (let node = 0; node < masks.length; node++) {
    for (let child = 0; child < 1 << dims; child++) {
      if ((masks[node]! >> (2 * child + 1)) & 1) of[(node << dims) + child] = count++;
    }
  }
  return { of, count };
}

/** What a node knows before its own mask: the value from above, and what is beside it. */
function inherit(level: Level, numbers: Int32Array, cell: number, dims: number, below: Level): void {
  const node = cell >> dims;
  const child = cell & ((1 << dims) - 1);
  const to = numbers[cell]!;
  const held = level.cells[cell]!;
  below.held[to] = held;
  below.isInner[to] = (level.masks[node]! >> (2 * child)) & 1;
  below.cells.fill(held, to << dims, (to + 1) << dims);
  for (let side = 0; side < 2 * dims; side++) {
    const axis = side < dims ? side : side - dims;
    const isInside = ((child >> axis) & 1) !== Number(side >= dims);
    const at = isInside ? node : level.links[2 * dims * node + side]!;
    const place = 2 * dims * to + side;
    if (at < 0) {
      below.outer[place] = level.outer[2 * dims * node + side]!;
      continue;
    }
    const beyond = (at << dims) + (child ^ (1 << axis));
    below.links[place] = numbers[beyond]!;
    below.outer[place] = level.cells[beyond]!;
  }
}
