/** `window.foveal`: for tests, and for pages that embed the viewer. */
import type { CameraState } from "../scene/navigation";
import type { RefinementFigures } from "../stream/refinement";
import type { State } from "./state";

export interface Stats {
  /** Of what is refined where it is looked at, or null. */
  readonly refinement: RefinementFigures | null;
  readonly triangles: number;
  readonly patches: number;
  readonly receivedBytes: number;
  readonly allBytes: number;
  /** Of patches on the GPU or waiting for it. */
  readonly cacheBytes: number;
  readonly cacheNodes: number;
  readonly memoryBudgetBytes: number;
  readonly triangleBudget: number;
  /** Largest screen error in view, pixels. */
  readonly errorPx: number;
  /** What is aimed at, pixels. */
  readonly targetPx: number;
  /** What this device draws in time, learned from its frames; infinite until they were too slow. */
  readonly motionTriangles: number;
  readonly inFlight: number;
  /** Milliseconds between frames that followed each other at once, the latest last. */
  readonly frameTimes: readonly number[];
  readonly frames: number;
  readonly gpu: { readonly geometries: number; readonly textures: number; readonly programs: number };
  /** Milliseconds since the navigation began. */
  readonly moments: { readonly firstPicture?: number; readonly firstSettled?: number };
  readonly isWholeFile: boolean;
}

export interface FovealApi {
  /** Settles at the first picture; fails with the sentence that the page shows. */
  readonly ready: Promise<void>;
  /** Settles when nothing moves, nothing is on its way and the picture is as good as asked for. */
  idle(): Promise<void>;
  stats(): Stats;
  getState(): State;
  setCamera(camera: CameraState, isSmooth?: boolean): void;
  setErrorPx(errorPx: number): void;
  setBudgets(budgets: { triangles?: number; bytes?: number }): void;
}

declare global {
  interface Window {
    foveal: FovealApi;
  }
}
