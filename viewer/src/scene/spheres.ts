/** Bounding spheres of the finest nodes in the cut, as three circles each. */
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from "three";
import { toFrame } from "./frame";
import type { Layer } from "./layer";

const SIDES = 48;

export class SphereLines {
  readonly lines = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: 0xd08a3c, transparent: true, opacity: 0.4 }),
  );

  constructor() {
    this.lines.frustumCulled = false;
    this.lines.visible = false;
  }

  /** Draw the spheres of what these layers show. */
  update(layers: readonly Layer[]): void {
    const points: number[] = [];
    for (const layer of layers) {
      const { graph, info } = layer.asset;
      for (let node = 0; node < graph.nodes; node++) {
        if (!isLeaf(layer, node)) continue;
        const [x, y, z, radius] = graph.spheres.subarray(4 * node, 4 * node + 4) as unknown as [
          number,
          number,
          number,
          number,
        ];
        const { origin } = info;
        const centre = toFrame(layer.frame, [x + origin[0], y + origin[1], z + origin[2]]);
        addCircles(points, centre, radius * layer.frame.scale);
      }
    }
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  }
}

/** Whether the node is in the cut and nothing finer takes the place of any of its patches. */
function isLeaf(layer: Layer, node: number): boolean {
  const { firstPatch, finer } = layer.asset.graph;
  const { expanded } = layer.selection;
  if (!expanded[node]) return false;
  for (let patch = firstPatch[node]!; patch < firstPatch[node + 1]!; patch++) {
    if (finer[patch]! >= 0 && expanded[finer[patch]!]) return false;
  }
  return true;
}

function addCircles(points: number[], centre: readonly [number, number, number], radius: number): void {
  for (let axis = 0; axis < 3; axis++) {
    for (let i = 0; i < SIDES; i++) {
      for (const step of [i, i + 1]) {
        const angle = (2 * Math.PI * step) / SIDES;
        const offset = [0, 0, 0];
        offset[(axis + 1) % 3] = radius * Math.cos(angle);
        offset[(axis + 2) % 3] = radius * Math.sin(angle);
        points.push(centre[0] + offset[0]!, centre[1] + offset[1]!, centre[2] + offset[2]!);
      }
    }
  }
}
