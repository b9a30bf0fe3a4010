/**
 * What a vertex's limit depends on, and a step of its ring, seen from the weights of what comes after.
 *
 * @module refine/slates/ringRules
 */

export interface Ring {
  /** At the vertex; one spoke more if it is on the border. */
  readonly faces: number;
  /** Their sharpness, counter-clockwise; infinite at borders. */
  readonly spokes: readonly number[];
  /** The vertex's own. */
  readonly sharpness: number;
}

export const SMOOTH = 0;
export const CREASE = 1;
export const CORNER = 2;

/** Which rule moves the vertex after `level` steps. */
export function kindOf({ spokes, sharpness }: Ring, level = 0): number {
  let sharp = 0;
  for (const s of spokes) if (s > level) sharp++;
  if (sharpness > level || sharp > 2) return CORNER;
  return sharp === 2 ? CREASE : SMOOTH;
}

export function sharpSpokes({ spokes }: Ring): number[] {
  const out: number[] = [];
  spokes.forEach((s, i) => {
    if (s > 0) out.push(i);
  });
  return out;
}

/** After how many steps it is settled. */
export function stepsOf({ spokes, sharpness }: Ring): number {
  let most = sharpness < Infinity ? sharpness : 0;
  for (const s of spokes) if (s < Infinity && s > most) most = s;
  return Math.ceil(most);
}

/** The same after so many steps. */
export function after({ faces, spokes, sharpness }: Ring, steps: number): Ring {
  const left = (s: number) => Math.max(s - steps, 0);
  return { faces, spokes: spokes.map(left), sharpness: left(sharpness) };
}

/** Weights on a ring that give what weights `row` give on the ring a step on. Linear in the ring. */
export function pulled(ring: Ring, row: Float64Array): Float64Array {
  const { faces, spokes } = ring;
  const n = spokes.length;
  const out = new Float64Array(row.length);
  const centres = row.slice(1 + n);
  for (let i = 0; i < n; i++) {
    const share = Math.min(spokes[i]!, 1);
    const weight = row[1 + i]!;
    const both = (share * weight) / 2 + ((1 - share) * weight) / 4;
    out[0]! += both;
    out[1 + i]! += both;
    centres[i > 0 ? i - 1 : faces - 1]! += ((1 - share) * weight) / 4;
    centres[i % faces]! += ((1 - share) * weight) / 4;
  }
  pullVertex(ring, row[0]!, out, centres);
  for (let i = 0; i < faces; i++) {
    const quarter = centres[i]! / 4;
    out[0]! += quarter;
    out[1 + i]! += quarter;
    out[1 + ((i + 1) % n)]! += quarter;
    out[1 + n + i]! += quarter;
  }
  return out;
}

/** The vertex moves by its rule; by both, weighted, in the step in which the rule changes. */
function pullVertex(ring: Ring, weight: number, out: Float64Array, centres: Float64Array): void {
  if (kindOf(ring) === kindOf(ring, 1)) {
    pullRule(ring, 0, weight, out, centres);
    return;
  }
  const ending = [...ring.spokes, ring.sharpness].filter((s) => s > 0 && s <= 1);
  const share = Math.min(ending.reduce((sum, s) => sum + s, 0) / ending.length, 1);
  pullRule(ring, 0, share * weight, out, centres);
  pullRule(ring, 1, (1 - share) * weight, out, centres);
}

/** The rule after `level` steps. */
function pullRule(ring: Ring, level: number, weight: number, out: Float64Array, centres: Float64Array): void {
  const n = ring.spokes.length;
  const kind = kindOf(ring, level);
  if (kind === CORNER) out[0]! += weight;
  else if (kind === CREASE) {
    out[0]! += 0.75 * weight;
    for (let i = 0; i < n; i++) if (ring.spokes[i]! > level) out[1 + i]! += weight / 8;
  } else {
    out[0]! += (weight * (n - 2)) / n;
    for (let i = 0; i < n; i++) {
      out[1 + i]! += weight / n ** 2;
      centres[i]! += weight / n ** 2;
    }
  }
}
