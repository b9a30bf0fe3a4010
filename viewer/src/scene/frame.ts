/** The viewer's own frame: the scene around its middle, scaled to a fixed size, so that any unit works. */
import type { Axis, MultiresInfo, Triple } from "../format/graph";

/** Radius of the whole scene here. Camera libraries compare with absolute thresholds; this is far above them. */
export const SCENE_RADIUS = 1000;

export interface Frame {
  /** Middle of the scene, in the assets' unit and axes; doubles, so UTM coordinates keep their last digit. */
  readonly centre: Triple;
  /** From the assets' unit to the viewer's. */
  readonly scale: number;
}

/** Least and greatest corner, in the assets' unit and axes. */
export type Box = readonly [Triple, Triple];

export function boxOf({ origin, step, box }: Pick<MultiresInfo, "origin" | "step" | "box">): Box {
  return box.map((corner) => corner.map((q, a) => origin[a]! + step * q)) as unknown as Box;
}

/** A frame that holds all boxes. */
export function frameOf(boxes: readonly Box[]): Frame {
  if (!boxes.length) return { centre: [0, 0, 0], scale: 1 };
  const low = [0, 1, 2].map((a) => Math.min(...boxes.map((box) => box[0][a]!)));
  const high = [0, 1, 2].map((a) => Math.max(...boxes.map((box) => box[1][a]!)));
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

/** Half the sides of the least box about the frame's middle that holds all boxes, in the frame. */
export function halfBoxOf(boxes: readonly Box[], frame: Frame): Triple {
  const reach = (a: number): number =>
    Math.max(0, ...boxes.flatMap((box) => box.map((corner) => Math.abs(corner[a]! - frame.centre[a]!))));
  return [0, 1, 2].map((a) => reach(a) * frame.scale) as unknown as Triple;
}
