/**
 * What the stage needs of a layer, whatever is in it.
 *
 * There are two kinds: patches chosen by view (`patchLayer.ts`), and a refinement whose buffers are changed in place by
 * messages (`refinedLayer.ts`), which calls `stage.invalidate` when something arrived. For each picture the
 * stage calls `choose` if the layer is visible, then `show`, and `follow` before each time that it is drawn.
 */
import type { Camera, Group, PerspectiveCamera } from "three";
import type { Triple } from "../format/graph";
import type { BackgroundColours } from "./background";
import type { LightShader } from "./light/shader";

/** What a picture may cost, or does. */
export interface Cost {
  readonly triangles: number;
  /** Of GPU memory. */
  readonly bytes: number;
}

/** How the faces of refinements are coloured. */
export const FACE_COLOURS = ["plain", "levels", "triplet"] as const;
export type FaceColours = (typeof FACE_COLOURS)[number];

/** How it is drawn, whatever is drawn. */
export interface Look {
  readonly areColoursOn: boolean;
  readonly arePatchesTinted: boolean;
  readonly isWireframe: boolean;
  readonly areSpheresOn: boolean;
  readonly faceColours: FaceColours;
  readonly background: BackgroundColours;
}

/**
 * What a layer is drawn for: the picture, lines over it, the depth under a pixel, the picture from elsewhere, the
 * shadow it casts; or to have a shader made before its first use.
 */
export type Pass = "picture" | "wires" | "depth" | "inset" | "cast" | "warm-up";

export interface Layer {
  readonly name: string;
  /** Drawn while it is visible. */
  readonly group: Group;
  readonly hasColours: boolean;
  /** It is made of patches, which can be told apart and have bounding spheres. */
  readonly hasPatches: boolean;
  /** Changes show at once, without a fade. */
  isStill: boolean;
  /** Bytes of its file. */
  readonly fileBytes: number;
  /** Received so far by its own ways; patches come by the streamer. */
  readonly receivedBytes: number;
  /** The file came as a whole, since the server has no ranges. */
  readonly isWholeFile: boolean;
  /** Largest screen error in view, in pixels, of the last choice. */
  readonly errorPx: number;
  /** It will look different in the next frame, even if nothing arrives and nobody moves. */
  readonly isFading: boolean;
  /** Nothing that it wants is on its way. */
  readonly isSettled: boolean;
  /** Another number whenever its shape in the next picture is another. */
  readonly version: number;
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
  /** Look like this from now on. */
  dress(look: Look): void;
  /** What is drawn next is drawn for this. */
  wear(pass: Pass): void;
  /** So the scene's light shines on it from now on. */
  lightBy(light: LightShader): void;
  /** What is drawn next is seen by this camera. */
  follow(camera: Camera): void;
  /** The bounding spheres of what is chosen, in the scene's frame. */
  forEachSphere(visit: (centre: Triple, radius: number) => void): void;
  /** The GPU is gone, and what was on it. */
  clear(): void;
}
