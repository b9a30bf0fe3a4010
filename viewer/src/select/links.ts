/**
 * Both directions of the patch graph, made once a file so that the selection walks arrays only.
 *
 * The *parents* of a node are the nodes that hold a patch which it refines; they come before it. Expects a
 * graph that `format/graph.ts` has checked.
 *
 * @module select/links
 */
import type { Graph } from "../format/graph";

export interface Links {
  /** n + 1: the parents of node i are parents[firstParent[i]] to parents[firstParent[i + 1] - 1], rising. */
  readonly firstParent: Int32Array;
  readonly parents: Int32Array;
  /** n + 1 */
  readonly firstChild: Int32Array;
  readonly children: Int32Array;
  /** n: triangles of the patches that the node refines, which it hides when it is expanded. */
  readonly hiddenTriangles: Float64Array;
}

/** Both directions of the graph, each link once. */
export function linksOf({ firstPatch, finer, triangles }: Graph): Links {
  const nodes = firstPatch.length - 1;
  const hiddenTriangles = new Float64Array(nodes);
  const childCounts = new Int32Array(nodes + 1);
  const parentCounts = new Int32Array(nodes + 1);
  const lastParent = new Int32Array(nodes).fill(-1); // the last parent that named a node, to count once
  for (let node = 0; node < nodes; node++) {
    for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) {
      const child = finer[patch]!;
      if (child < 0) continue;
      hiddenTriangles[child] = hiddenTriangles[child]! + triangles[patch]!;
      if (lastParent[child] === node) continue;
      lastParent[child] = node;
      childCounts[node + 1] = childCounts[node + 1]! + 1;
      parentCounts[child + 1] = parentCounts[child + 1]! + 1;
    }
  }
  const firstChild = runningSum(childCounts);
  const firstParent = runningSum(parentCounts);
  const children = new Int32Array(firstChild[nodes]!);
  const parents = new Int32Array(firstParent[nodes]!);
  const nextParent = firstParent.slice();
  lastParent.fill(-1);
  for (let node = 0; node < nodes; node++) {
    let next = firstChild[node]!;
    for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) {
      const child = finer[patch]!;
      if (child < 0 || lastParent[child] === node) continue;
      lastParent[child] = node;
      children[next++] = child;
      const at = nextParent[child]!;
      parents[at] = node;
      nextParent[child] = at + 1;
    }
  }
  return { firstParent, parents, firstChild, children, hiddenTriangles };
}

function runningSum(counts: Int32Array): Int32Array {
  for (let i = 1; i < counts.length; i++) counts[i] = counts[i]! + counts[i - 1]!;
  return counts;
}

/** n: the sum of a column of patches over each node, such as its bytes. */
export function sumPerNode(firstPatch: Uint32Array, perPatch: ArrayLike<number>): Float64Array {
  const sums = new Float64Array(firstPatch.length - 1);
  for (let node = 0; node < sums.length; node++) {
    let sum = 0;
    for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) sum += perPatch[patch]!;
    sums[node] = sum;
  }
  return sums;
}
