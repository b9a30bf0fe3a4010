/**
 * The masks of a control mesh's vertices as flat arrays: one for each kind of ring that there is.
 *
 * @module refine/slates/tables
 */
import { Problem } from "../../format/problem";
import { TAGGED } from "./layout";
import { type Mask, maskOf, sideMasks } from "./masks";
import type { Ring } from "./ringRules";

export interface MaskTables {
  /** A vertex's mask, whose rows `maskStarts` places in `weights`, one after the other. */
  readonly maskOf: Int32Array;
  readonly maskStarts: Int32Array;
  readonly weights: Float64Array;
  /** First row and number of the pairs, first row and number of the areas. */
  readonly sectors: Int32Array;
  /** Of masks in `sectors`. */
  readonly sectorStarts: Int32Array;
  /** A normal for each sector of a vertex. */
  readonly normalStarts: Int32Array;
  /** The normal at a corner. */
  readonly normalOf: Int32Array;
}

/** What rings are made of. */
export interface Rings {
  readonly corners: Int32Array;
  readonly place: Int32Array;
  readonly ringStarts: Int32Array;
  readonly spokes: Float64Array;
  readonly fans: Int32Array;
  readonly kinds: Uint8Array;
  readonly vertexSharp: Float64Array;
}

/** Of all masks together: 128 MB, or one vertex of 2,000 faces. Their number grows with its square. */
const MOST_WEIGHTS = 2 ** 24;

/**
 * @param settled - After so many steps nothing is semi-sharp.
 * @throws Problem if a vertex has thousands of faces.
 */
export function maskTables(rings: Rings, settled: number, name: string): MaskTables {
  const { masks, numbers } = masksOf(rings, settled, name);
  const [maskStarts, sectorStarts] = [new Int32Array(masks.length + 1), new Int32Array(masks.length + 1)];
  masks.forEach(({ rows, sectors }, i) => {
    maskStarts[i + 1] = maskStarts[i]! + rows.length * rows[0]!.length;
    sectorStarts[i + 1] = sectorStarts[i]! + sectors.length;
  });
  const weights = new Float64Array(maskStarts.at(-1)!);
  const sectors = new Int32Array(4 * sectorStarts.at(-1)!);
  masks.forEach((mask, i) => {
    let at = maskStarts[i]!;
    for (const row of mask.rows) {
      weights.set(row, at);
      at += row.length;
    }
    mask.sectors.forEach(({ pairs, areas }, j) => {
      sectors.set([...pairs, ...areas], 4 * (sectorStarts[i]! + j));
    });
  });
  const normalStarts = new Int32Array(numbers.length + 1);
  numbers.forEach((mask, v) => {
    normalStarts[v + 1] = normalStarts[v]! + masks[mask]!.sectors.length;
  });
  const normalOf = normalsOf(rings, numbers, masks, normalStarts);
  return { maskOf: numbers, maskStarts, weights, sectors, sectorStarts, normalStarts, normalOf };
}

function masksOf({ ringStarts, spokes, fans, kinds, vertexSharp }: Rings, settled: number, name: string) {
  const numbers = new Int32Array(fans.length);
  const masks: Mask[] = [];
  const known = new Map<string, number>();
  let left = MOST_WEIGHTS;
  for (let v = 0; v < fans.length; v++) {
    const [begin, faces] = [ringStarts[v]!, fans[v]!];
    const count = ringStarts[v + 1]! - begin - faces;
    // Python has one for each valence of what is smooth too, whichever kind it is called.
    const own = spokes.subarray(begin, begin + count);
    const key = kinds[v] === TAGGED ? `${faces} ${vertexSharp[v]} ${own.join(" ")}` : `${faces}`;
    let number = known.get(key);
    if (number === undefined) {
      left -= (2 * faces + 3) * (1 + count + faces);
      if (left < 0) {
        throw new Problem(
          "damaged",
          `${name} has ${faces} faces at vertex ${v}, or too many sharp ones; a page has no memory for that.`,
        );
      }
      number = masks.length;
      const ring: Ring = { faces, spokes: [...own], sharpness: vertexSharp[v]! };
      masks.push(maskOf(ring, settled));
      known.set(key, number);
    }
    numbers[v] = number;
  }
  return { masks, numbers };
}

function normalsOf({ corners, place }: Rings, numbers: Int32Array, masks: Mask[], normalStarts: Int32Array) {
  const sectorOf = masks.map(({ sectors }) => {
    const own: number[] = [];
    sectors.forEach(({ faces }, j) => {
      for (const f of faces) own[f] = j;
    });
    return Int32Array.from(own);
  });
  return corners.map((v, h) => normalStarts[v]! + sectorOf[numbers[v]!]![place[h]!]!);
}

/** Rows of side masks by semi-sharp sharpness, and which of them each side has. */
export function sideTables(sharp: Float64Array): { sideClass: Int32Array; sideMasks: Float64Array } {
  const numbers = new Map<number, number>();
  const sideClass = new Int32Array(sharp.length);
  for (let h = 0; h < sharp.length; h++) {
    const s = sharp[h]!;
    if (!(s > 0 && s < Infinity)) continue;
    if (!numbers.has(s)) numbers.set(s, numbers.size);
    sideClass[h] = numbers.get(s)!;
  }
  const classes = [...numbers.keys()];
  const tables = classes.map(sideMasks);
  const size = tables[0]?.length ?? sideMasks(0).length;
  const out = new Float64Array(size * Math.max(1, classes.length));
  tables.forEach((table, i) => {
    out.set(table, size * i);
  });
  return { sideClass, sideMasks: out };
}
