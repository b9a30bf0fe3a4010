/**
 * How many triangles a picture may have while the camera moves, so that frames come in time.
 *
 * In motion the logarithm of the budget follows the logarithm of the time aimed at over the frame's, a plain
 * integral control: it falls while frames are slower, rises while they are faster and it is used up, and rests
 * where they are equal. A budget, not a larger error: next to the eye errors are infinite whatever is aimed at,
 * and just there a flight over the dragon drew 280,000 triangles, 400 ms of a software rasteriser's time.
 * A still picture is drawn once, so it may take its time; from what it took a first guess is made.
 */
/** 40 frames a second: above a 60 Hz screen's 16.7, below its missed frame's 33.3. */
export const AIM_MS = 25;
const FALL = 0.12; // with the median's delay of two frames, the most that does not overshoot (4/27)
/** So many times too slow, it hurries. */
const HURRIED = 2;
const HURRIED_FALL = 0.4;
const RISE = 0.03; // a slow frame is seen at once, some detail less in motion is not
/** Fewer do not help: they take a software rasteriser 11 ms, while the pixels of a full page take it 60. */
export const LEAST_TRIANGLES = 40_000;
/** No frame counts as longer; the median takes care of single pauses. */
const LONGEST_MS = 400;
const FRAMES = 5;
const FEWEST_FRAMES = 3;
/** The budget in force follows in steps, or details at its edge would come and go with every frame. */
const STEP = 1.25;

export class MotionBudget {
  /** What a frame may take. */
  aimMs = AIM_MS;
  #allowed = Number.POSITIVE_INFINITY;
  #inForce = Number.POSITIVE_INFINITY;
  #recent: { milliseconds: number; triangles: number }[] = [];

  /** Triangles that a picture in motion may have; infinite until frames were too slow. */
  get triangles(): number {
    return this.#inForce;
  }

  /** Note a frame that followed another at once, so many milliseconds later, and what it drew. */
  frame(milliseconds: number, triangles: number, isMoving: boolean): void {
    this.#recent.push({ milliseconds: Math.min(milliseconds, LONGEST_MS), triangles });
    if (this.#recent.length > FRAMES) this.#recent.shift();
    if (this.#recent.length < FEWEST_FRAMES) return;
    const times = this.#recent.map((frame) => frame.milliseconds).sort((a, b) => a - b);
    const median = times[times.length >> 1]!;
    const drawn = Math.max(...this.#recent.map((frame) => frame.triangles));
    if (isMoving) this.#follow(median, drawn);
    else if (median > this.aimMs) this.#allowed = Math.min(this.#allowed, (drawn * this.aimMs) / median);
    this.#allowed = Math.max(this.#allowed, LEAST_TRIANGLES);
    const change = this.#allowed / this.#inForce;
    if (!(change > 1 / STEP && change < STEP)) this.#inForce = this.#allowed;
  }

  /** Begin a new motion: old frame times say nothing of it. What was learned stays. */
  restart(): void {
    this.#recent = [];
  }

  #follow(median: number, drawn: number): void {
    const { aimMs } = this;
    if (median > aimMs) {
      const fall = median > HURRIED * aimMs ? HURRIED_FALL : FALL;
      this.#allowed = Math.min(this.#allowed, drawn) * (aimMs / median) ** fall;
    } else if (drawn > this.#allowed / 2) {
      this.#allowed *= (aimMs / median) ** RISE; // what was not used up was not tried
    }
  }
}
