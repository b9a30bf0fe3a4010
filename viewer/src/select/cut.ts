/**
 * Which nodes to expand for a view: largest screen error first, within budgets. Also what to load next.
 *
 * API:
 *
 *     const selection = new Selection(graph);        // once a file: links are built here
 *     selection.select(view, { errorPx: 1, triangleBudget: 3e6, byteBudget: 2e8, available });
 *     selection.drawn.subarray(0, selection.drawnCount)     // patches to draw, larger screen error first
 *     selection.wanted.subarray(0, selection.wantedCount)   // nodes to load, larger screen error first
 *     selection.expanded[node]                              // 1 if the node's patches are in use
 *     selection.triangles, .heldBytes, .errorPx             // of the cut; errorPx is the largest left in view
 *     selection.screenError(node)                           // of any node in the last view, for eviction
 *
 * - Every result is overwritten by the next `select`. Nothing is allocated there.
 * - First all nodes count as available, and are expanded in the order of falling screen error (of equals the
 *   lower index) while the error is above `errorPx`, the node may be seen, all its parents are expanded, and
 *   the next one keeps within the budgets. Of these, what is available and has all parents expanded makes the
 *   cut; what is not available is wanted. So nothing is loaded that the budgets would not let in, what
 *   arrives never pushes out what is there, and a larger budget expands the same nodes and more.
 * - Node 0 is expanded whatever the budgets, once it is available; before, nothing is drawn.
 * - A pure function of its arguments: no memory of earlier frames, hence no flicker.
 * - Lengths are in the asset's unit, relative to its origin. Knows neither three.js, the network nor time.
 *
 * The same rule, operation by operation, as `src/foveal/lod/select.py`; both are held to
 * `spec/golden/selection.json`.
 *
 * Based on: P. Cignoni et al. Batched Multi Triangulation. IEEE Visualization, 2005.
 *
 * @module select/cut
 */

import type { Graph } from "../format/graph";
import { sphereInFrustum } from "./frustum";
import { type Links, linksOf, sumPerNode } from "./links";
import { NodeHeap } from "./nodeHeap";
import { screenError, type View } from "./screenError";

export interface SelectOptions {
  /** Nodes with a screen error above this are expanded. Below 0: all that may be seen. */
  readonly errorPx: number;
  /** Limit of the triangles drawn; none by default. */
  readonly triangleBudget?: number;
  /** Limit of the bytes of expanded nodes; none by default. */
  readonly byteBudget?: number;
  /** n: not 0 for the nodes at hand; all by default. */
  readonly available?: Uint8Array;
  /** Whether what the frustum has outside is left coarse and not drawn; yes by default. */
  readonly isCulling?: boolean;
}

export class Selection {
  /** n: 1 for the nodes whose patches are in use; with every node its parents. */
  readonly expanded: Uint8Array;
  /** The first `drawnCount` are the patches to draw. */
  readonly drawn: Int32Array;
  drawnCount = 0;
  /** The first `wantedCount` are the nodes that the view asks for and that are not available, parents first. */
  readonly wanted: Int32Array;
  wantedCount = 0;
  /** Of the drawn patches. */
  triangles = 0;
  /** Of the expanded nodes, by `nodeBytes`. */
  heldBytes = 0;
  /** The largest screen error left in view. `Infinity` while node 0 is not available. */
  errorPx = Number.POSITIVE_INFINITY;

  readonly #graph: Graph;
  readonly #links: Links;
  readonly #nodeBytes: Float64Array;
  readonly #keys: Float64Array; // screen errors of the nodes whose parents are in the ideal cut
  readonly #heap: NodeHeap;
  readonly #order: Int32Array; // the ideal cut, as far as #chosen
  #chosen = 0;
  readonly #pending: Int32Array; // parents that are not yet expanded
  readonly #parentCounts: Int32Array;
  readonly #seen: Uint8Array; // 0 not looked at, 1 may be seen, 2 is outside
  #view: View | undefined;

  /**
   * @param nodeBytes n: what each node costs of the byte budget; by default its encoded size
   */
  constructor(graph: Graph, nodeBytes: Float64Array = sumPerNode(graph.firstPatch, graph.patchBytes)) {
    const nodes = graph.errors.length;
    if (nodeBytes.length !== nodes) throw new Error("nodeBytes must have one number a node.");
    this.#graph = graph;
    this.#links = linksOf(graph);
    this.#nodeBytes = nodeBytes;
    this.#keys = new Float64Array(nodes);
    this.#heap = new NodeHeap(this.#keys);
    this.#order = new Int32Array(nodes);
    this.#pending = new Int32Array(nodes);
    this.#parentCounts = new Int32Array(nodes);
    for (let node = 0; node < nodes; node++)
      this.#parentCounts[node] = this.#links.firstParent[node + 1]! - this.#links.firstParent[node]!;
    this.#seen = new Uint8Array(nodes);
    this.expanded = new Uint8Array(nodes);
    this.wanted = new Int32Array(nodes);
    this.drawn = new Int32Array(graph.finer.length);
  }

  /** Choose for a view; the results are in the fields. */
  select(view: View, options: SelectOptions): void {
    const {
      triangleBudget = Number.POSITIVE_INFINITY,
      byteBudget = Number.POSITIVE_INFINITY,
      available,
      isCulling = true,
    } = options;
    this.#view = view;
    this.#seen.fill(isCulling ? 0 : 1);
    this.#seen[0] = 1; // what stands in node 0 is decided patch by patch
    this.errorPx = 0;
    this.#chooseIdeal(options.errorPx, triangleBudget, byteBudget);
    this.#chooseReal(available, triangleBudget);
    this.#listDrawn();
  }

  /** Screen error in pixels of any node in the view of the last `select`, in sight or not. */
  screenError(node: number): number {
    const { spheres, errors } = this.#graph;
    if (this.#view === undefined) return Number.POSITIVE_INFINITY;
    const at = 4 * node;
    return screenError(
      errors[node]!,
      spheres[at]!,
      spheres[at + 1]!,
      spheres[at + 2]!,
      spheres[at + 3]!,
      this.#view,
    );
  }

  /** Fill #order with the nodes to expand were all at hand; stops at the first that breaks a budget. */
  #chooseIdeal(errorPx: number, triangleBudget: number, byteBudget: number): void {
    const { firstChild, children } = this.#links;
    const heap = this.#heap;
    const keys = this.#keys;
    this.#pending.set(this.#parentCounts);
    heap.clear();
    keys[0] = Number.POSITIVE_INFINITY;
    let shown = 0;
    let held = 0;
    let node = 0;
    this.#chosen = 0;
    for (;;) {
      this.#order[this.#chosen++] = node;
      shown += this.#costTriangles(node);
      held += this.#nodeBytes[node]!;
      for (let at = firstChild[node]!; at < firstChild[node + 1]!; at++) {
        const child = children[at]!;
        const pending = this.#pending[child]! - 1;
        this.#pending[child] = pending;
        if (pending > 0 || !this.#isSeen(child)) continue;
        const key = this.screenError(child);
        keys[child] = key;
        if (key > errorPx) heap.push(child);
        else if (key > this.errorPx) this.errorPx = key;
      }
      if (heap.size === 0) return;
      node = heap.top;
      const isOver =
        shown + this.#costTriangles(node) > triangleBudget || held + this.#nodeBytes[node]! > byteBudget;
      if (isOver) {
        this.errorPx = Math.max(this.errorPx, keys[node]!);
        return;
      }
      heap.pop();
    }
  }

  /** Expand what is at hand of the ideal cut and list what is not. */
  #chooseReal(available: Uint8Array | undefined, triangleBudget: number): void {
    const { expanded, wanted } = this;
    const { firstParent, parents } = this.#links;
    expanded.fill(0);
    this.wantedCount = 0;
    this.triangles = 0;
    this.heldBytes = 0;
    for (let i = 0; i < this.#chosen; i++) {
      const node = this.#order[i]!;
      let isReady = available === undefined || available[node] !== 0;
      if (!isReady) wanted[this.wantedCount++] = node;
      for (let at = firstParent[node]!; isReady && at < firstParent[node + 1]!; at++)
        isReady = expanded[parents[at]!] !== 0;
      const cost = this.#costTriangles(node);
      // The root is shown whatever the budget. That a part of a cut within the budget is within it too
      // holds unless a patch is culled that its node's finer ones are not, so it is checked.
      if (isReady && (node === 0 || this.triangles + cost <= triangleBudget)) {
        expanded[node] = 1;
        this.triangles += cost;
        this.heldBytes += this.#nodeBytes[node]!;
      } else {
        this.errorPx = Math.max(this.errorPx, this.#keys[node]!);
      }
    }
  }

  /** List the patches that stand in the cut, node by node. */
  #listDrawn(): void {
    const { firstPatch, finer } = this.#graph;
    const { expanded, drawn } = this;
    let count = 0;
    for (let i = 0; i < this.#chosen; i++) {
      const node = this.#order[i]!;
      if (expanded[node] === 0) continue;
      for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) {
        const child = finer[patch]!;
        if (child >= 0 && expanded[child] !== 0) continue;
        if (this.#isSeen(child >= 0 ? child : node)) drawn[count++] = patch;
      }
    }
    this.drawnCount = count;
  }

  /** How many triangles more are drawn when a node is expanded and none of its children is. */
  #costTriangles(node: number): number {
    const { firstPatch, finer, triangles } = this.#graph;
    let cost = -this.#links.hiddenTriangles[node]!;
    for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) {
      const child = finer[patch]!;
      if (this.#isSeen(child >= 0 ? child : node)) cost += triangles[patch]!;
    }
    return cost;
  }

  /** Whether a node may show, expanded or not: what stands for it is within its error of its sphere. */
  #isSeen(node: number): boolean {
    const known = this.#seen[node]!;
    if (known !== 0) return known === 1;
    const { spheres, errors } = this.#graph;
    const at = 4 * node;
    const error = errors[node]!;
    const reach = spheres[at + 3]! + (error < Number.POSITIVE_INFINITY ? error : 0);
    const isSeen = sphereInFrustum(
      this.#view!.planes,
      spheres[at]!,
      spheres[at + 1]!,
      spheres[at + 2]!,
      reach,
    );
    this.#seen[node] = isSeen ? 1 : 2;
    return isSeen;
  }
}
