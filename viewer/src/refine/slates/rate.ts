/**
 * A rate of frames held by a budget of triangles: the feedback of the paper's section 3.1.
 *
 * Based on: V. Settgast, K. Müller, Chr. Fünfzig, D. Fellner. Adaptive tessellation of subdivision surfaces.
 *
 * @module refine/slates/rate
 */

/** Of the wished time: within it nothing changes, else noise would move patches in every frame. */
const BAND = 0.06;
/** Up to here a step goes most of the way, from here on as far as one depth does. */
const NEAR = 0.25;
/** What one depth more or less does to the triangles. */
const FOURFOLD = 4;
/** Whose median is looked at near the wish; far from it the last frame says enough. */
const FRAMES = 3;
const FIRST = 100_000;

/**
 * Which budget of triangles keeps to a rate; `tell` it what each frame took. Far from the wished time it changes by
 * whole depths, near it by some patches to the neighbouring depth.
 */
export class FrameRate {
  budget: number;
  #recent: number[] = [];
  readonly #wish: number;
  readonly #most: number;

  constructor(
    readonly rate: number,
    private readonly least: number,
    most: number,
  ) {
    this.#wish = 1000 / rate;
    this.#most = Math.max(least, most);
    this.budget = Math.min(Math.max(FIRST, least), this.#most);
  }

  /** What the last frame took, in milliseconds, with so many triangles. */
  tell(frame: number, triangles: number): void {
    this.#recent = [...this.#recent.slice(1 - FRAMES), Math.max(frame, 1e-6)];
    let off = this.#recent.at(-1)! / this.#wish - 1;
    if (Math.abs(off) < NEAR) {
      if (this.#recent.length < FRAMES) return;
      off = this.#recent.toSorted((a, b) => a - b)[1]! / this.#wish - 1;
    }
    if (Math.abs(off) <= BAND || (off < 0 && triangles < this.budget / FOURFOLD)) return;
    let share = 1 / (1 + off);
    if (Math.abs(off) < NEAR) share = 1 + 0.7 * (share - 1);
    share = Math.min(Math.max(share, 1 / FOURFOLD), FOURFOLD);
    const next = Math.min(triangles, this.budget) * share;
    this.budget = Math.floor(Math.min(Math.max(next, this.least), this.#most));
    this.#recent = [];
  }
}
