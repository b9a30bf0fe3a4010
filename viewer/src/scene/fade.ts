/**
 * How far each node has come into the picture, 0 to 1, so that finer patches replace coarser ones gently.
 *
 * A patch of node i with finer node j shows where a pixel's hash is in [phase j, phase i): for every hash exactly
 * one patch of those that stand in for each other. This holds at every moment and for every order of
 * expanding and collapsing, because phase j <= phase i always: j is expanded only while its parents are, and
 * all phases move at the same speed.
 */
export class Fade {
  readonly phase: Float32Array;
  readonly #moving = new Set<number>();

  constructor(
    nodes: number,
    /** Milliseconds from 0 to 1; 0 switches at once. */
    public duration: number,
  ) {
    this.phase = new Float32Array(nodes);
  }

  get isMoving(): boolean {
    return this.#moving.size > 0;
  }

  /** Move towards what is expanded by so many milliseconds. Node 0 is there at once: it covers nothing. */
  advance(expanded: Uint8Array, elapsed: number): void {
    // Where frames are so slow that it would be seen in one of them, it would only cost: both are drawn.
    const stride = 2 * elapsed > this.duration ? 1 : elapsed / this.duration;
    for (let node = 0; node < this.phase.length; node++) {
      const goal = expanded[node] ? 1 : 0;
      const now = this.phase[node]!;
      if (now === goal) continue;
      const next = node === 0 ? goal : goal > now ? Math.min(1, now + stride) : Math.max(0, now - stride);
      this.phase[node] = next;
      // As it was stored: nine steps of a ninth may end below 1 as a double and at 1 as a float.
      if (this.phase[node] === goal) this.#moving.delete(node);
      else this.#moving.add(node);
    }
  }

  /** A node that is gone shows nothing and does not move. */
  forget(node: number): void {
    this.phase[node] = 0;
    this.#moving.delete(node);
  }

  /** All are gone. */
  reset(): void {
    this.phase.fill(0);
    this.#moving.clear();
  }
}
