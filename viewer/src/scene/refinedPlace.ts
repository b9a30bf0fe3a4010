/** Between a refined asset's own coordinates and those of the camera, both ways. */
import { type Camera, Matrix4, type PerspectiveCamera, Vector3 } from "three";
import type { Triple } from "../format/graph";
import type { WireCamera } from "../stream/refinement";
import { type Box, type Frame, fromFrame } from "./frame";

const { fround } = Math;

export class RefinedPlace {
  /** A place near the eye, relative to the asset's origin, in float32. */
  readonly reference = new Vector3();
  /** From places relative to the reference to the eye's own axes. */
  readonly toEye = new Matrix4();
  readonly #placed = new Matrix4();
  readonly #eye = new Vector3();

  constructor(
    private readonly origin: Triple,
    private readonly box: Box,
    private readonly frame: Frame,
  ) {}

  /**
   * Choose the reference for this camera, and make its matrix in doubles: what the shader subtracts from nearby
   * vertices is then exact, and what it rounds is small against the distance to the eye.
   */
  follow(camera: Camera): void {
    const eye = fromFrame(this.frame, this.#eye.setFromMatrixPosition(camera.matrixWorld).toArray());
    const near = eye.map((x, a) => Math.min(Math.max(x, this.box[0][a]!), this.box[1][a]!));
    const reference = near.map((x, a) => fround(x - this.origin[a]!)) as [number, number, number];
    this.reference.set(...reference);
    const { scale, centre } = this.frame;
    const at = reference.map((x, a) => (x + this.origin[a]! - centre[a]!) * scale) as [
      number,
      number,
      number,
    ];
    this.#placed.makeScale(scale, scale, scale).setPosition(...at);
    this.toEye.multiplyMatrices(camera.matrixWorldInverse, this.#placed);
  }

  /** What a refinement is told of the camera; `height` is the picture's, in pixels. */
  cameraOf(camera: PerspectiveCamera, height: number): WireCamera {
    const { frame } = this;
    const e = camera.matrixWorld.elements;
    const eye: Triple = [e[12]!, e[13]!, e[14]!];
    // the middle of the scene is about as far as what is looked at, so no digit is lost in the difference
    const ahead = Math.max(camera.near, Math.hypot(...eye));
    const target: Triple = [eye[0] - ahead * e[8]!, eye[1] - ahead * e[9]!, eye[2] - ahead * e[10]!];
    return {
      position: fromFrame(frame, eye),
      target: fromFrame(frame, target),
      up: [e[4]!, e[5]!, e[6]!],
      fov: (camera.fov * Math.PI) / 180,
      width: Math.max(1, Math.round(height * camera.aspect)),
      height,
      near: camera.near / frame.scale,
      far: camera.far / frame.scale,
    };
  }
}
