/** Bounding spheres of what is shown, as three circles each. */
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from "three";
import type { Triple } from "../format/graph";
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
      layer.forEachSphere((centre, radius) => addCircles(points, centre, radius));
    }
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  }
}

function addCircles(points: number[], centre: Triple, radius: number): void {
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
