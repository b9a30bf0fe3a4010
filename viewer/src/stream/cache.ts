/** Which nodes to let go when memory is short: first what was not drawn for longest, then what matters least. */

export interface CacheEntry {
  readonly key: number;
  readonly bytes: number;
  /** Error that shows while the node is not there, for ties. */
  readonly error: number;
  lastUsed: number;
}

/** Fill level down to which eviction goes once the budget is passed, so that it does not run at every frame. */
const LOW = 0.9;

export class ByteCache {
  readonly #entries = new Map<number, CacheEntry>();
  #bytes = 0;

  /** Of all entries, in use or not. */
  get bytes(): number {
    return this.#bytes;
  }

  get size(): number {
    return this.#entries.size;
  }

  add(key: number, bytes: number, error: number, now: number): void {
    this.remove(key);
    this.#entries.set(key, { key, bytes, error, lastUsed: now });
    this.#bytes += bytes;
  }

  /** Mark as in use in frame `now`. */
  touch(key: number, now: number): void {
    const entry = this.#entries.get(key);
    if (entry) entry.lastUsed = now;
  }

  remove(key: number): void {
    const entry = this.#entries.get(key);
    if (!entry) return;
    this.#entries.delete(key);
    this.#bytes -= entry.bytes;
  }

  clear(): void {
    this.#entries.clear();
    this.#bytes = 0;
  }

  /**
   * Keys to let go so that the whole and `coming` bytes fit `budget` again; none while they fit.
   *
   * What was touched in frame `now` is never among them: if the present picture alone is over the budget,
   * the error target has to rise, not the picture to break.
   */
  evict(budget: number, coming: number, now: number): number[] {
    if (this.#bytes + coming <= budget) return [];
    const idle = [...this.#entries.values()].filter((entry) => entry.lastUsed < now);
    idle.sort((a, b) => a.lastUsed - b.lastUsed || a.error - b.error || b.key - a.key);
    const out: number[] = [];
    for (const entry of idle) {
      if (this.#bytes + coming <= LOW * budget) break;
      this.remove(entry.key);
      out.push(entry.key);
    }
    return out;
  }
}
