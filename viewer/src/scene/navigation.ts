/** How the camera moves: camera-controls in the scene's frame, told in the assets' units. */
import CameraControls from "camera-controls";
import {
  Box3,
  MathUtils,
  Matrix4,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Sphere,
  Spherical,
  Vector2,
  Vector3,
  Vector4,
} from "three";
import type { Triple } from "../format/graph";
import { type Frame, fromFrame, SCENE_RADIUS, toFrame } from "./frame";

CameraControls.install({
  THREE: { Box3, Matrix4, Quaternion, Raycaster, Sphere, Spherical, Vector2, Vector3, Vector4 },
});

/** A view, in the assets' unit and axes. */
export interface CameraState {
  readonly position: Triple;
  readonly target: Triple;
  readonly up: Triple;
  readonly fieldOfViewDegrees: number;
}

const SMOOTH_SECONDS = 0.12;
const HOME_DIRECTION: Triple = [0.3, 0.25, 1]; // right, up, towards the visitor
const HOME_MARGIN = 1.12;

export class Navigation {
  readonly camera = new PerspectiveCamera(40, 1, 1, 10 * SCENE_RADIUS);
  readonly controls: CameraControls;
  frame: Frame = { centre: [0, 0, 0], scale: 1 };
  /** Half the sides of the scene's box, in its frame. */
  halfBox: Triple = [577, 577, 577];
  #isStill: boolean;

  constructor(
    element: HTMLElement,
    /** Called when a frame is due: the library tells of gestures and flights, not of moves at once. */
    private readonly onMove: () => void,
    isStill: boolean,
  ) {
    this.controls = new CameraControls(this.camera, element);
    const { controls } = this;
    this.#isStill = isStill;
    this.isStill = isStill;
    controls.dollyToCursor = true;
    controls.minDistance = SCENE_RADIUS * 2e-4;
    controls.maxDistance = SCENE_RADIUS * 30;
    controls.infinityDolly = true;
    const { ACTION } = CameraControls;
    controls.mouseButtons.middle = ACTION.TRUCK;
    controls.touches.one = ACTION.TOUCH_ROTATE;
    controls.touches.two = ACTION.TOUCH_DOLLY_TRUCK;
    controls.touches.three = ACTION.TOUCH_TRUCK;
    for (const type of ["control", "controlstart", "transitionstart"] as const) {
      controls.addEventListener(type, onMove);
    }
    element.addEventListener("pointerdown", (event) => this.#shiftPans(event), { capture: true });
  }

  /** No inertia and no flights, for those who asked for reduced motion. */
  set isStill(isStill: boolean) {
    this.#isStill = isStill;
    this.controls.smoothTime = isStill ? 0 : SMOOTH_SECONDS;
    this.controls.draggingSmoothTime = isStill ? 0 : SMOOTH_SECONDS / 2;
  }

  get isStill(): boolean {
    return this.#isStill;
  }

  /** Shift with the left button pans, as the right button does. */
  #shiftPans(event: PointerEvent): void {
    const { ACTION } = CameraControls;
    this.controls.mouseButtons.left = event.shiftKey ? ACTION.TRUCK : ACTION.ROTATE;
  }

  getCamera(): CameraState {
    const position = this.controls.getPosition(new Vector3());
    const target = this.controls.getTarget(new Vector3());
    return {
      position: fromFrame(this.frame, position.toArray()),
      target: fromFrame(this.frame, target.toArray()),
      up: this.camera.up.toArray(),
      fieldOfViewDegrees: this.camera.fov,
    };
  }

  setCamera(state: CameraState, isSmooth = false): void {
    this.setUp(state.up);
    this.setFieldOfView(state.fieldOfViewDegrees);
    const position = toFrame(this.frame, state.position);
    const target = toFrame(this.frame, state.target);
    void this.controls.setLookAt(...position, ...target, isSmooth && !this.#isStill);
    this.onMove();
  }

  setUp(up: Triple): void {
    const next = new Vector3(...up);
    if (next.lengthSq() === 0) return;
    next.normalize();
    if (next.distanceTo(this.camera.up) < 1e-9) return;
    this.camera.up.copy(next);
    this.controls.updateCameraUp();
  }

  setFieldOfView(degrees: number): void {
    this.camera.fov = MathUtils.clamp(degrees, 5, 120);
    this.camera.updateProjectionMatrix();
    this.onMove();
  }

  /** Where the eye is from the pivot: shares to the right, up and to the front, a unit vector. */
  direction(): [right: number, up: number, front: number] {
    const away = this.controls
      .getPosition(new Vector3())
      .sub(this.controls.getTarget(new Vector3()))
      .normalize();
    const { up } = this.camera;
    const front = frontOf(up);
    return [away.dot(new Vector3().crossVectors(up, front).normalize()), away.dot(up), away.dot(front)];
  }

  /** The whole scene, from the front and a little above. */
  home(isSmooth: boolean): void {
    const { camera } = this;
    const up = camera.up.clone();
    const front = frontOf(up);
    const right = new Vector3().crossVectors(up, front).normalize();
    const [r, u, f] = HOME_DIRECTION;
    const towards = new Vector3()
      .addScaledVector(right, r)
      .addScaledVector(up, u)
      .addScaledVector(front, f)
      .normalize();
    const distance = distanceToFit(this.halfBox, towards, up, camera) * HOME_MARGIN;
    const eye = towards.multiplyScalar(distance);
    void this.controls.setLookAt(eye.x, eye.y, eye.z, 0, 0, 0, isSmooth && !this.#isStill);
    this.onMove();
  }

  /** Turn by degrees about the pivot. */
  orbit(rightDegrees: number, upDegrees: number): void {
    const { degToRad } = MathUtils;
    void this.controls.rotate(degToRad(-rightDegrees), degToRad(-upDegrees), !this.#isStill);
    this.onMove();
  }

  /** Move by a share of the picture's height. */
  pan(right: number, up: number): void {
    const height = 2 * this.controls.distance * Math.tan(MathUtils.degToRad(this.camera.fov) / 2);
    void this.controls.truck(right * height, -up * height, !this.#isStill);
    this.onMove();
  }

  /** Divide the distance to the pivot. */
  zoom(factor: number): void {
    const target = this.controls.getTarget(new Vector3());
    const distance = this.controls.getPosition(new Vector3()).distanceTo(target);
    void this.controls.dollyTo(distance / factor, !this.#isStill);
    this.onMove();
  }

  /** Turn to this point of the scene's frame and orbit about it from now on. */
  focus(point: Vector3): void {
    void this.controls.setTarget(point.x, point.y, point.z, !this.#isStill);
    this.onMove();
  }

  /**
   * Bring the pivot to this depth along the line of sight, which changes nothing in the picture. Zooming then
   * slows down towards the surface that is looked at, instead of passing through it.
   */
  anchor(depth: number): void {
    const position = this.controls.getPosition(new Vector3(), false);
    const target = this.controls.getTarget(new Vector3(), false);
    target.sub(position).setLength(depth).add(position);
    void this.controls.setLookAt(...position.toArray(), ...target.toArray(), false);
  }

  /** Clipping planes as tight as the scene allows, so that depth keeps its precision. */
  fitClipping(): void {
    const { camera } = this;
    const distance = camera.position.length();
    const outside = distance - 1.01 * SCENE_RADIUS;
    const inside = Math.max(1e-6 * SCENE_RADIUS, 0.02 * this.controls.distance);
    camera.near = Math.max(outside, Math.min(inside, distance + SCENE_RADIUS));
    camera.far = Math.max(distance + 1.01 * SCENE_RADIUS, camera.near * 2);
    camera.updateProjectionMatrix();
  }
}

/** Level direction from the scene to who stands before it: -y where z is up, else +z. */
export function frontOf(up: Vector3): Vector3 {
  const front = Math.abs(up.z) > 0.7 ? new Vector3(0, -1, 0) : new Vector3(0, 0, 1);
  return front.addScaledVector(up, -front.dot(up)).normalize();
}

/**
 * From how far the corners of a box about the origin are all in the picture.
 *
 * @param towards - Unit vector from the box to the eye.
 */
export function distanceToFit(
  halfBox: Triple,
  towards: Vector3,
  up: Vector3,
  { fov, aspect }: PerspectiveCamera,
): number {
  const right = new Vector3().crossVectors(up, towards).normalize();
  const above = new Vector3().crossVectors(towards, right);
  const tanY = Math.tan(MathUtils.degToRad(fov) / 2);
  const tanX = tanY * aspect;
  let distance = 0;
  for (let corner = 0; corner < 8; corner++) {
    const [x, y, z] = halfBox.map((half, axis) => ((corner >> axis) & 1 ? half : -half)) as [
      number,
      number,
      number,
    ];
    const point = new Vector3(x, y, z);
    const across = Math.max(Math.abs(point.dot(right)) / tanX, Math.abs(point.dot(above)) / tanY);
    distance = Math.max(distance, point.dot(towards) + across);
  }
  return distance;
}
