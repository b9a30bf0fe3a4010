/**
 * Arrays that grow, and whose rows are lent in runs that stay where they are: those given back are lent again by size.
 *
 * Sizes are rounded up to a quarter of their highest bit: blocks of (2^d + 1)^2 lose a tenth to a fifth so.
 *
 * @module refine/slates/arena
 */

/** Some rows one after the other: the first, and how many. */
type Run = readonly [place: number, size: number];

type Values = Float32Array | Float64Array | Uint32Array | Uint8Array;

export class Arena {
  /** So many rows were ever lent. */
  rows = 0;
  #room = 0;
  /** By class of size the places given back, the last one lent first. */
  readonly #free: number[][] = [];

  /**
   * Columns of one length. What is not lent is zero, but for columns that `clear` is not called for.
   *
   * @param grow - Make room for so many rows in all of them.
   */
  constructor(private readonly grow: (rows: number) => void) {}

  allocate(size: number): number {
    const kind = classOf(size);
    if (kind === 0) return 0;
    const free = this.#free[kind]?.pop();
    if (free !== undefined) return free;
    const place = this.rows;
    this.rows += roomOf(kind);
    return place;
  }

  /** Have room for all that was lent: by a half more, since twice would be much of what never grows again. */
  fit(): void {
    if (this.rows <= this.#room) return;
    this.#room = Math.max(this.rows, Math.floor((this.#room * 3) / 2));
    this.grow(this.#room);
  }

  release([place, size]: Run): void {
    const kind = classOf(size);
    if (kind === 0) return;
    this.#free[kind] ??= [];
    this.#free[kind].push(place);
  }

  /** The row after those that are lent for a run. */
  end([place, size]: Run): number {
    return place + roomOf(classOf(size));
  }
}

/** The number of the least rounded size that is no smaller: 4 to an octave. */
function classOf(size: number): number {
  if (size <= 4) return size;
  let [exponent, rest] = [0, size - 1];
  while (rest >= 8) {
    rest >>= 1;
    exponent++;
  }
  return 4 * exponent + rest + 1;
}

/** The rounded size of a class. */
function roomOf(kind: number): number {
  if (kind <= 4) return kind;
  const exponent = Math.floor((kind - 5) / 4);
  return (kind - 4 * exponent) << exponent;
}

/** A longer array that begins with the same. */
export function longer<T extends Values>(values: T, length: number): T {
  const out = new (values.constructor as new (length: number) => T)(length);
  out.set(values as never);
  return out;
}

/** Rows as begins and ends, ascending, joined where they touch. */
export class Ranges {
  readonly #runs: Run[] = [];

  add(place: number, size: number): void {
    if (size > 0) this.#runs.push([place, place + size]);
  }

  /** One after the other: begin, end, begin, end. */
  bounds(): number[] {
    const out: number[] = [];
    for (const [begin, end] of this.#runs.sort((a, b) => a[0] - b[0])) {
      const last = out.length - 1;
      if (last > 0 && begin <= out[last]!) out[last] = Math.max(out[last]!, end);
      else out.push(begin, end);
    }
    return out;
  }
}
