/** Adaptive binary range decoding, as `foveal.coding.binary` codes (spec/shadows.md, "Bits"). */

const QUICK = 4;
const SLOW = 7;
const EVEN = 1 << 15;
const TOP = 1 << 24;

/** More than a byte can stand for: a bit takes at least 0.0014 bits. */
export const MOST_BITS_A_BYTE = 8192;

/** What is known of the bits in each context: estimates of the chance of a 0, in 2^-16. */
export class Chances {
  readonly quick: Uint16Array;
  readonly slow: Uint16Array;

  constructor(contexts: number) {
    this.quick = new Uint16Array(contexts).fill(EVEN);
    this.slow = new Uint16Array(contexts).fill(EVEN);
  }
}

/** Reads bits of any bytes, and zeros past their end; `chances` are learnt further. */
export class BitReader {
  private readonly quick: Uint16Array;
  private readonly slow: Uint16Array;
  private width = 0xffffffff;
  private code = 0;
  private at = 0;

  constructor(
    private readonly data: Uint8Array,
    chances: Chances,
  ) {
    this.quick = chances.quick;
    this.slow = chances.slow;
    for (let i = 0; i < 4; i++) this.shift();
  }

  /** More was read than there is. */
  get isPastEnd(): boolean {
    return this.at > this.data.length;
  }

  /** As many bytes were read as there are. */
  get isAtEnd(): boolean {
    return this.at === this.data.length;
  }

  bit(context: number): number {
    const quick = this.quick[context]!;
    const slow = this.slow[context]!;
    let width = this.width;
    const bound = (width >>> 12) * ((quick + slow) >>> 5); // below 2^32
    let bit = 0;
    if (this.code >= bound) {
      bit = 1;
      this.code -= bound;
      width -= bound;
      this.quick[context] = quick - (quick >>> QUICK);
      this.slow[context] = slow - (slow >>> SLOW);
    } else {
      width = bound;
      this.quick[context] = quick + ((65536 - quick) >>> QUICK);
      this.slow[context] = slow + ((65536 - slow) >>> SLOW);
    }
    while (width < TOP) {
      width *= 256;
      this.shift();
    }
    this.width = width;
    return bit;
  }

  private shift(): void {
    const byte = this.at < this.data.length ? this.data[this.at]! : 0;
    this.code = this.code * 256 + byte; // below the width, so below 2^32
    this.at++;
  }
}
