/** When frames come: how long after one another, and whether the camera moves. */

/** How long after the last movement the camera counts as moving. */
const SETTLE_MS = 180;
const TIMES_KEPT = 600;
/** Of what moves by time: a longer frame is not a longer step. */
const LONGEST_STEP_MS = 100;
const FIRST_STEP_MS = 16;

export class FrameClock {
  /** Milliseconds between frames that followed each other at once, the latest last. */
  readonly times: number[] = [];
  /** Milliseconds that the present frame moves things on. */
  elapsed = FIRST_STEP_MS;
  /** The next frame follows at once; else, after a rest, the clock begins anew: a long pause is not a long step. */
  isOn = false;
  /** Milliseconds from the beginning of the last frame until it was drawn, as far as the page can tell. */
  spent = 0;
  #now = 0;
  #lastMoved = Number.NEGATIVE_INFINITY;

  /** Begin a frame; how long after the one before, or null if that did not call for it. */
  begin(now: number): number | null {
    const interval = now - this.#now;
    this.#now = now;
    this.elapsed = this.isOn ? Math.min(interval, LONGEST_STEP_MS) : FIRST_STEP_MS;
    if (!this.isOn) return null;
    this.times.push(interval);
    if (this.times.length > TIMES_KEPT) this.times.shift();
    return interval;
  }

  /** The present frame is drawn. */
  end(now: number): void {
    this.spent = Math.max(0, now - this.#now);
  }

  /** The camera moved in this frame. */
  move(): void {
    this.#lastMoved = this.#now;
  }

  get isMoving(): boolean {
    return this.#now - this.#lastMoved < SETTLE_MS;
  }
}
