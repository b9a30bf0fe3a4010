/**
 * A binary heap of node indices: the largest key first, of equals the lowest node.
 *
 * The order is total, so what comes out does not depend on how the heap is built. Allocates only when made.
 *
 * @module select/nodeHeap
 */

export class NodeHeap {
  size = 0;
  readonly #nodes: Int32Array;
  readonly #keys: Float64Array;

  /** @param keys one number a node; the heap reads them, the caller writes them before a push */
  constructor(keys: Float64Array) {
    this.#keys = keys;
    this.#nodes = new Int32Array(keys.length);
  }

  /** The node that `pop` would take. Undefined behaviour on an empty heap. */
  get top(): number {
    return this.#nodes[0]!;
  }

  clear(): void {
    this.size = 0;
  }

  push(node: number): void {
    const nodes = this.#nodes;
    let at = this.size++;
    while (at > 0) {
      const above = (at - 1) >> 1;
      const other = nodes[above]!;
      if (!this.#comesFirst(node, other)) break;
      nodes[at] = other;
      at = above;
    }
    nodes[at] = node;
  }

  /** Take the top away. */
  pop(): void {
    const nodes = this.#nodes;
    const size = --this.size;
    const node = nodes[size]!;
    let at = 0;
    for (;;) {
      let below = 2 * at + 1;
      if (below >= size) break;
      if (below + 1 < size && this.#comesFirst(nodes[below + 1]!, nodes[below]!)) below++;
      const other = nodes[below]!;
      if (!this.#comesFirst(other, node)) break;
      nodes[at] = other;
      at = below;
    }
    nodes[at] = node;
  }

  #comesFirst(a: number, b: number): boolean {
    const keyA = this.#keys[a]!;
    const keyB = this.#keys[b]!;
    return keyA > keyB || (keyA === keyB && a < b);
  }
}
