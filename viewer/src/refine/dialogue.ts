/**
 * What a refinement in this page and the picture say to each other, whatever the scheme.
 *
 * It knows requests and messages (spec/wire.md), not how they travel. A request is answered by one message at most, so
 * the newest camera is the one that counts; a page that draws slowly asks less often.
 *
 * The same as `src/foveal/refine/dialogue.py`.
 *
 * @module refine/dialogue
 */
import type { Wish } from "../stream/refinement";
import { type SlotParts, slotMessage } from "./slotMessage";

/** All that a page wants, as on the wire. */
export interface Request extends Wish {
  /** Milliseconds that the page took for its last picture. */
  readonly drawn_ms: number;
  /** Of the last message that was applied, 0 if none was or all is to be sent anew. */
  readonly seen: number;
}

/** A page's own limit: 200 MB of refinement, and what a phone still draws. */
export const MOST_TRIANGLES = 1_000_000;

/** One page's part. A scheme brings its mesh to what is wanted, and says what there is then. */
export abstract class Dialogue {
  /** Sent normals in the place of where vertices were born. */
  protected readonly hasNormals: boolean = false;
  protected triangles = 0;
  /** What the refinement stands at. */
  protected last: Request | null = null;
  #wanted = "";
  #sequence = 0;

  /** @param clock - Milliseconds; for tests. */
  constructor(protected readonly clock: () => number) {}

  /** Whether nothing would change before another request. */
  protected abstract get isSettled(): boolean;

  /** By how much edges wanted were multiplied. */
  protected abstract get threshold(): number;

  /** Bring the mesh to what is wanted, and set what it stands at and how many triangles there are. */
  protected abstract refine(request: Request, begin: number, isNew: boolean): void;

  /** What the page is to have, and what of it changed since the last message; all of it if it is anew. */
  protected abstract parts(request: Request, isAnew: boolean): SlotParts;

  /** What an answer in a moving view took, beside what the page told. */
  protected abstract spent(request: Request, milliseconds: number): void;

  /** The next message, or null if there is none before another request. */
  answer(request: Request): ArrayBuffer | null {
    const isAnew = request.seen !== this.#sequence || this.#sequence === 0;
    const wanted = JSON.stringify({ ...request, drawn_ms: 0, seen: 0 });
    const isNew = wanted !== this.#wanted;
    const isDone = !isNew && this.isSettled;
    if (isDone && !isAnew) return null;
    const begin = this.clock();
    this.#wanted = wanted;
    if (!isDone) this.refine(request, begin, isNew);
    const message = this.#message(request, this.clock() - begin, isAnew);
    if (isNew && this.#sequence > 1) this.spent(request, this.clock() - begin);
    return message;
  }

  #message(request: Request, milliseconds: number, isAnew: boolean): ArrayBuffer {
    const parts = this.parts(request, isAnew);
    const head = {
      sequence: this.#sequence + 1,
      base: parts.isFresh ? 0 : this.#sequence,
      isSettled: this.isSettled,
      isLimit: request.positions === "limit" || this.hasNormals,
      hasNormals: this.hasNormals,
      triangles: this.triangles,
      milliseconds,
      threshold: this.threshold,
    };
    this.#sequence = head.sequence;
    return slotMessage(head, parts);
  }
}
