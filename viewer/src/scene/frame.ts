/** The viewer's own frame: the scene around its middle, scaled to a fixed size, so that any unit works. */
import type { Axis, Triple } from "../format/graph";
import type { Asset } from "../stream/asset";

/** Radius of the whole scene here. Camera libraries compare with absolute thresholds; this is far above them. */
export const SCENE_RADIUS = 1000;

export interface Frame {
  /** Middle of the scene, in the assets' unit and axes; doubles, so UTM coordinates keep their last digit. */
  readonly centre: Triple;
  /** From the assets' unit to the viewer's. */
  readonly scale: number;
}

/** A frame that holds the boxes of all assets. */
export function frameOf(assets: readonly Asset[]): Frame {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const { info } of assets) {
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis]!, info.origin[axis]! + info.step * info.box[0][axis]!);
      high[axis] = Math.max(high[axis]!, info.origin[axis]! + info.step * info.box[1][axis]!);
    }
  }
  if (!assets.length) return { centre: [0, 0, 0], scale: 1 };
  const centre = [0, 1, 2].map((a) => (low[a]! + high[a]!) / 2) as unknown as Triple;
  const radius = Math.hypot(...[0, 1, 2].map((a) => (high[a]! - low[a]!) / 2));
  return { centre, scale: SCENE_RADIUS / Math.max(radius, Number.MIN_VALUE * 1e20) };
}

export function toFrame(frame: Frame, point: Triple): Triple {
  return [0, 1, 2].map((a) => (point[a]! - frame.centre[a]!) * frame.scale) as unknown as Triple;
}

export function fromFrame(frame: Frame, point: Triple): Triple {
  return [0, 1, 2].map((a) => point[a]! / frame.scale + frame.centre[a]!) as unknown as Triple;
}

export const UP: Readonly<Record<Axis, Triple>> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** Half the sides of the box of all assets, in their frame. */
export function halfBoxOf(assets: readonly Asset[], frame: Frame): [number, number, number] {
  const half: [number, number, number] = [0, 0, 0];
  for (const { info } of assets) {
    for (let axis = 0; axis < 3; axis++) {
      for (const corner of info.box) {
        const at = info.origin[axis]! + info.step * corner[axis]! - frame.centre[axis]!;
        half[axis] = Math.max(half[axis]!, Math.abs(at) * frame.scale);
      }
    }
  }
  return half;
}
