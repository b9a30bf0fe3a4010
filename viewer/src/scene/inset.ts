/** A picture from elsewhere, in a corner of the picture: where detail is, and where the camera that it is for. */
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  MathUtils,
  PerspectiveCamera,
  Vector3,
} from "three";
import type { Triple } from "../format/graph";
import { SCENE_RADIUS } from "./frame";
import { distanceToFit, frontOf } from "./navigation";
import { FIRST_TURN, type Turn } from "./turn";

/** Where the inset is on the canvas, in CSS pixels from its top left corner. */
export interface InsetPlace {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

const FIELD_OF_VIEW = 30;
/** Surfaces do not reach the corners of their boxes. */
const MARGIN = 0.85;
const LINES = 0xe08a3c;
/** Corners of the picture, round it. */
const CORNERS = [
  [-1, -1],
  [1, -1],
  [1, 1],
  [-1, 1],
] as const;

export class Inset {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 10 * SCENE_RADIUS);
  /** The frustum that is looked at: in full where it is in front, faint where the surface hides it. */
  readonly frustum = new Group();
  place: InsetPlace | null = null;
  turn: Turn = FIRST_TURN;
  /** Half the sides of the scene's box, in its frame. */
  halfBox: Triple = [577, 577, 577];
  readonly #points = new Float32Array(3 * 16);
  readonly #geometry = new BufferGeometry();

  constructor() {
    this.#geometry.setAttribute("position", new BufferAttribute(this.#points, 3));
    const lines = (opacity: number, isAlways: boolean): LineSegments =>
      new LineSegments(
        this.#geometry,
        new LineBasicMaterial({ color: LINES, transparent: true, opacity, depthTest: !isAlways }),
      );
    this.frustum.add(lines(1, false), lines(0.35, true));
    for (const line of this.frustum.children) line.frustumCulled = false;
    this.frustum.visible = false;
  }

  /**
   * Bring camera and lines up to date.
   *
   * @param main - The camera of the picture.
   * @param depth - How far ahead of it its frustum is drawn.
   */
  follow(main: PerspectiveCamera, depth: number): void {
    if (!this.place) return;
    this.#aim(main.up, this.place.width / this.place.height);
    const e = main.matrixWorld.elements;
    const axis = (i: number): Vector3 => new Vector3(e[4 * i], e[4 * i + 1], e[4 * i + 2]);
    const eye = axis(3);
    const tanY = Math.tan(MathUtils.degToRad(main.fov) / 2);
    const corners = CORNERS.map(([x, y]) =>
      eye
        .clone()
        .addScaledVector(axis(2), -depth)
        .addScaledVector(axis(0), x * depth * tanY * main.aspect)
        .addScaledVector(axis(1), y * depth * tanY),
    );
    const pairs = corners.flatMap((corner, i) => [eye, corner, corner, corners[(i + 1) % 4]!]);
    for (const [i, point] of pairs.entries()) point.toArray(this.#points, 3 * i);
    this.#geometry.getAttribute("position").needsUpdate = true;
  }

  /** All of the scene, from where it is turned to. */
  #aim(up: Vector3, aspect: number): void {
    const { camera } = this;
    const [azimuth, elevation] = this.turn.map(MathUtils.degToRad) as unknown as Turn;
    const front = frontOf(up);
    const away = front.clone().applyAxisAngle(up, azimuth).multiplyScalar(Math.cos(elevation));
    away.addScaledVector(up, Math.sin(elevation));
    away.normalize();
    camera.aspect = aspect;
    const distance = MARGIN * distanceToFit(this.halfBox, away, up, camera);
    camera.up.copy(up);
    camera.position.copy(away).multiplyScalar(distance);
    camera.lookAt(0, 0, 0);
    camera.near = Math.max(0.01 * distance, distance - 1.01 * SCENE_RADIUS);
    camera.far = 4 * distance;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }
}
