/**
 * What the stage needs of a layer, whatever is in it.
 *
 * There is one kind, patches chosen by view (`patchLayer.ts`). Another, say one whose buffers are changed in place
 * by messages, has its place beside it: it calls `stage.invalidate` when something arrived. For each picture the
 * stage calls `choose` if the layer is visible, then `show`, and `follow` before each time that it is drawn.
 */
import type { Camera, Group, PerspectiveCamera } from "three";
import type { Triple } from "../format/graph";

/** What a picture may cost, or does. */
export interface Cost {
  readonly triangles: number;
  /** Of GPU memory. */
  readonly bytes: number;
}

export interface Layer {
  readonly name: string;
  /**
   * Drawn while it is visible. Wires and picks draw it once more with one material for all its meshes, so these
   * have the attributes that `material.ts` names.
   */
  readonly group: Group;
  readonly hasColours: boolean;
  areColoursOn: boolean;
  /** Changes show at once, without a fade. */
  isStill: boolean;
  /** Bytes of its file. */
  readonly fileBytes: number;
  /** The file came as a whole, since the server has no ranges. */
  readonly isWholeFile: boolean;
  /** Largest screen error in view, in pixels, of the last choice. */
  readonly errorPx: number;
  /** It will look different in the next frame, even if nothing arrives and nobody moves. */
  readonly isFading: boolean;
  /** Nothing that it wants is on its way. */
  readonly isSettled: boolean;
  /** What was drawn since the last `follow`. */
  readonly drawn: { patches: number; triangles: number };
  /**
   * Choose what to show to this camera: not worse than `errorPx` pixels if that may be had for what is allowed.
   *
   * @param height - Of the picture, in pixels.
   * @returns What it takes of what is allowed.
   */
  choose(camera: PerspectiveCamera, height: number, errorPx: number, allowed: Cost): Cost;
  /** Make the group look as chosen, so many milliseconds after the last picture. */
  show(elapsed: number): void;
  /** What is drawn next is seen by this camera. */
  follow(camera: Camera): void;
  /** The bounding spheres of what is chosen, in the scene's frame. */
  forEachSphere(visit: (centre: Triple, radius: number) => void): void;
  /** The GPU is gone, and what was on it. */
  clear(): void;
}
