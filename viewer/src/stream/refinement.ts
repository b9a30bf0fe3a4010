/**
 * A refinement that follows a camera, wherever it is computed.
 *
 * The layer that draws it (`scene/refinedLayer.ts`) says for each picture what it wants, and hears what changed in
 * the slot buffers. Who computes is behind this interface: a server by a WebSocket (`live.ts`), or, where a scene
 * is static files, the page itself.
 */
import type { Criteria, DepthRules, Positions } from "../format/cage";
import type { Triple } from "../format/graph";
import type { Problem } from "../format/problem";
import type { SlotBuffers, SlotChanges } from "../format/wire";

/** As on the wire (spec/wire.md): in the asset's own coordinates, angles in radians. */
export interface WireCamera {
  readonly position: Triple;
  readonly target: Triple;
  readonly up: Triple;
  readonly fov: number;
  readonly width: number;
  readonly height: number;
  readonly near: number;
  readonly far: number;
}

/** All that a refinement depends on. */
export interface Wish {
  readonly camera: WireCamera;
  readonly criteria: Criteria;
  /** Of `catmull-clark` alone. */
  readonly depths?: DepthRules;
  /** Triangles at most, 0 for no limit. */
  readonly budget: number;
  readonly positions: Positions;
  /** Frames a second to hold, 0 for no such wish. */
  readonly rate: number;
}

/** What a refinement says of its last step. */
export interface RefinementFigures {
  readonly triangles: number;
  /** That the refinement took. */
  readonly milliseconds: number;
  /** By how much edges wanted were multiplied to keep budget and rate, 1 or more. */
  readonly threshold: number;
  /** Messages applied since the page opened. */
  readonly updates: number;
  readonly receivedBytes: number;
}

export interface RefinementListener {
  /** The slots have changed; called after they did, before anything else may change them. */
  onChange(changes: SlotChanges): void;
  /** Something is wrong, or (null) all is well again. */
  onProblem(problem: Problem | null): void;
}

export interface RefinementSource {
  readonly slots: SlotBuffers;
  readonly figures: RefinementFigures;
  /** The slots are what was wished for last, and nothing more will come by itself. */
  readonly isSettled: boolean;
  /** Hear of what comes from now on; there is one listener. */
  listen(listener: RefinementListener): void;
  /**
   * Say what is wanted, for each picture: the newest wish holds. It also tells that what came before was drawn, so
   * a page that draws slowly is sent less.
   *
   * @param drawnMs - What the last picture took.
   */
  request(wish: Wish, drawnMs: number): void;
  /** Try again now, after a problem. */
  retry(): void;
  dispose(): void;
}
