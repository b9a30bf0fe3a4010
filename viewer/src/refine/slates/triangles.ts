/**
 * Triangles of patches, without gaps where depths differ.
 *
 * A patch's quadrangles along a side beyond which it is deeper become fans: their hub is the limit of the next step's
 * face point, their rim has the deeper side's points, and where two of them are neighbours along the side the edge
 * between them is cut at its next limit point. All of these lie in the patch's own block, which is computed a step
 * deeper than it is shown then, or in the rim of the side.
 *
 * Based on: Settgast, Müller, Fünfzig, Fellner, section 3.3.
 *
 * @module refine/slates/triangles
 */
import type { Places } from "./blocks";
import { sideRow, sideRowAhead } from "./patch";

/** Two triangles for each quadrangle of a patch f of depth d, from row o of `out` on. */
export function showEven(blocks: Places, f: number, d: number, out: Uint32Array, o: number): void {
  const base = blocks.places[f]!;
  const deepest = blocks.depths[f]!;
  const stride = 1 << (deepest - d);
  const row = stride * ((1 << deepest) + 1);
  let i = 3 * o;
  for (let r = 0; r < 1 << d; r++) {
    for (let c = 0; c < 1 << d; c++) {
      const a = base + r * row + c * stride;
      out[i] = out[i + 3] = a;
      out[i + 1] = a + stride;
      out[i + 2] = out[i + 4] = a + stride + row;
      out[i + 5] = a + row;
      i += 6;
    }
  }
}

/** The same, with fans along sides that are deeper; `sides` are four from `h` on. */
export function showFans(
  blocks: Places,
  f: number,
  d: number,
  sides: Int8Array,
  h: number,
  out: Uint32Array,
  o: number,
): void {
  const n = 1 << d;
  const deepest = blocks.depths[f]!;
  const half = 1 << (deepest - d - 1); // a block of one step more at least
  const row = half * ((1 << deepest) + 1);
  const fan = new Fan(blocks, f, d, sides.subarray(h, h + 4), out, 3 * o, half, row);
  for (let r = 0; r < n; r++) {
    for (let c = 0; c < n; c++) {
      const a = blocks.places[f]! + 2 * (r * row + c * half);
      if (fan.isAt(r, c)) fan.show(r, c, a);
      else fan.quadrangle(a);
    }
  }
}

class Fan {
  readonly #last: number;
  /** Which sides are deeper. */
  readonly #isDeeper: readonly boolean[];
  /** From each corner of a quadrangle half way to the next, and the corners themselves. */
  readonly #ahead: readonly number[];
  readonly #corners: readonly number[];

  constructor(
    private readonly blocks: Places,
    private readonly f: number,
    private readonly d: number,
    private readonly sides: Int8Array,
    private readonly out: Uint32Array,
    private at: number,
    half: number,
    row: number,
  ) {
    this.#last = (1 << d) - 1;
    this.#isDeeper = [...sides].map((side) => side > d);
    this.#ahead = [half, row, -half, -row];
    this.#corners = [0, 2 * half, 2 * (half + row), 2 * row];
  }

  /** Whether the quadrangle of row r and column c has a fan. */
  isAt(r: number, c: number): boolean {
    for (let k = 0; k < 4; k++) if (this.#isDeeper[k] && this.#isBorder(k, r, c)) return true;
    return false;
  }

  quadrangle(a: number): void {
    const [, b, c, d] = this.#corners;
    this.#put(a, a + b!, a + c!);
    this.#put(a, a + c!, a + d!);
  }

  /** Around the middle of the quadrangle of row r, column c, whose corner is a. */
  show(r: number, c: number, a: number): void {
    const last = this.#last;
    const hub = a + this.#ahead[0]! + this.#ahead[1]!;
    let point = a;
    for (let k = 0; k < 4; k++) {
      const isBorder = this.#isBorder(k, r, c);
      if (isBorder && this.#isDeeper[k]) {
        const along = k === 0 ? c : k === 1 ? r : k === 2 ? last - c : last - r;
        const pieces = 1 << (this.sides[k]! - this.d);
        for (let t = 1; t < pieces; t++) {
          const beyond = this.#rimPoint(k, along * pieces + t);
          this.#put(hub, point, beyond);
          point = beyond;
        }
      } else if (!isBorder && this.#isCut(k, r, c)) {
        const middle = a + this.#corners[k]! + this.#ahead[k]!;
        this.#put(hub, point, middle);
        point = middle;
      }
      const end = a + this.#corners[(k + 1) % 4]!;
      this.#put(hub, point, end);
      point = end;
    }
  }

  #put(a: number, b: number, c: number): void {
    this.out[this.at++] = a;
    this.out[this.at++] = b;
    this.out[this.at++] = c;
  }

  #isBorder(k: number, r: number, c: number): boolean {
    return k === 0 ? r === 0 : k === 1 ? c === this.#last : k === 2 ? r === this.#last : c === 0;
  }

  /** Whether the quadrangles at both sides of inner edge k are fans along one side. */
  #isCut(k: number, r: number, c: number): boolean {
    const [first, second, third, fourth] = this.#isDeeper;
    if (k % 2 === 0) return (c === 0 && fourth!) || (c === this.#last && second!);
    return (r === 0 && first!) || (r === this.#last && third!);
  }

  /** The row of point t of side k at the side's depth: of the block if that is deep enough, else of the rim. */
  #rimPoint(k: number, t: number): number {
    const { places, depths, rims, rimDepths } = this.blocks;
    const deepest = depths[this.f]!;
    const depth = this.sides[k]!;
    if (depth <= deepest) {
      const size = (1 << deepest) + 1;
      return places[this.f]! + sideRow(k, size) + (t << (deepest - depth)) * sideRowAhead(k, size);
    }
    const h = 4 * this.f + k;
    return rims[h]! + (t << (rimDepths[h]! - depth));
  }
}
