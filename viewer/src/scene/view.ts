/** What the selection knows of the camera. */
import type { PerspectiveCamera } from "three";
import { setFrustum } from "../select/frustum";
import type { View } from "../select/screenError";
import type { Asset } from "../stream/asset";
import type { Frame } from "./frame";

type Vector = [number, number, number];

/** The camera in the asset's unit, relative to its origin; `height` is the picture's, in pixels. */
export function viewOf(camera: PerspectiveCamera, height: number, frame: Frame, asset: Asset): View {
  const e = camera.matrixWorld.elements;
  const { origin } = asset.info;
  const axis = (i: number): Vector => [e[4 * i]!, e[4 * i + 1]!, e[4 * i + 2]!];
  const eye = axis(3).map((x, a) => x / frame.scale + frame.centre[a]! - origin[a]!) as Vector;
  const tanY = Math.tan((camera.fov * Math.PI) / 360);
  const near = camera.near / frame.scale;
  const planes = new Float64Array(20);
  setFrustum(planes, eye, axis(0), axis(1), axis(2), tanY * camera.aspect, tanY, near);
  return { eye, near, planes, pixelsPerRadian: height / (2 * tanY) };
}
