/**
 * The error target that is aimed at: the visitor's own while the picture is still, a larger one in motion if
 * frames would be slow.
 *
 * In motion the logarithm of the target follows the logarithm of frame time over the time aimed at, a plain
 * integral control: it rises while frames are slower, falls while they are faster, and rests where they are
 * equal, since a larger error never draws more triangles. There are no thresholds that it could hang between.
 * What motion learned is kept for the next motion. A still picture is drawn once, so it may take its time.
 */
const AIM_MS = 25; // 40 frames a second: above a 60 Hz screen's 16.7, below its missed frame's 33.3
const GAIN = 0.12; // with the median's delay of two frames, the most that does not overshoot (4/27)
/** Far too slow, it hurries: a software rasteriser got there in a dozen frames, each a third of a second. */
const HURRIED_MS = 2 * AIM_MS;
const HURRIED_GAIN = 0.4;
const MOST_RAISED = 16;
/** Longer pauses are not slow frames: the page was hidden, or something else blocked it. */
const LONGEST_MS = 400;

export class ErrorTarget {
  #raised = 0; // logarithm of the factor in motion
  #recent: number[] = [];

  constructor(public basePx: number) {}

  /** How far the target in motion is above the base. */
  get factor(): number {
    return Math.exp(this.#raised);
  }

  /** Note a frame that followed another at once, so many milliseconds later. */
  frame(milliseconds: number): void {
    if (milliseconds > LONGEST_MS && this.#recent.length) return;
    this.#recent.push(Math.min(milliseconds, LONGEST_MS));
    if (this.#recent.length > 5) this.#recent.shift();
    const median = [...this.#recent].sort((a, b) => a - b)[this.#recent.length >> 1]!;
    const gain = median > HURRIED_MS ? HURRIED_GAIN : GAIN;
    const next = this.#raised + gain * Math.log(median / AIM_MS);
    this.#raised = Math.min(Math.log(MOST_RAISED), Math.max(0, next));
  }

  /** Begin a new motion: old frame times say nothing of it. */
  restart(): void {
    this.#recent = [];
  }

  pixels(isMoving: boolean): number {
    return this.basePx * (isMoving ? this.factor : 1);
  }
}
