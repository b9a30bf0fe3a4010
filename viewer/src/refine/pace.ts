/**
 * Which threshold keeps to a budget of triangles and to a rate of frames.
 *
 * The one thing that is turned is a factor on `edge_px`, in steps of an eighth of an octave. For one view the number
 * of triangles never rises with it, since what is wanted by a coarser threshold is wanted by a finer one. So the
 * least step within the budget is a function of the view alone, which `Pace` finds wherever it begins; a rate is
 * held by the budget that it takes, from what a triangle cost in the last frames.
 *
 * The same as `src/foveal/refine/pace.py`; both are held to golden/sqrt3.json.
 *
 * @module refine/pace
 */
import { type Criteria, REGIONS, type RegionLimits } from "../format/cage";

/** 2^(i / 8), written out: powers differ between machines in the last bit. */
const EIGHTHS = [
  1,
  1.0905077326652577,
  1.189207115002721,
  1.2968395546510096,
  Math.SQRT2,
  1.5422108254079407,
  1.681792830507429,
  1.8340080864093424,
];
const OCTAVE = EIGHTHS.length;

/** A factor of 10^12: only what the eye is in has an edge so large. */
export const COARSEST = 40 * OCTAVE;

const NO_EDGE_PX = 1 / 256;
const AFAR_PX = 8;
/** A step changes the triangles by about 1.19, and where many pass a level at once by more. */
const SPARE = 1.5;
const FRAMES = 7;
/** Fewer triangles or a larger budget by this have a step tried anew that was too much. */
const CHANGE = 1.1;
/** Less than this the budget of a rate does not follow what was measured. */
const SHIFT = 1.2;

const NOT_TRIED = { over: -1, triangles: 0, budget: 0 };

/** By how much `edge_px` is multiplied at a step. */
export function factor(step: number): number {
  return EIGHTHS[step % OCTAVE]! * 2 ** Math.floor(step / OCTAVE);
}

/** Criteria with `edge_px` multiplied by the factor of a step; 0 counts as 1/256 above step 0. */
export function coarser(criteria: Criteria, step: number): Criteria {
  if (step === 0) return criteria;
  const stretched = (own: RegionLimits): RegionLimits => ({
    ...own,
    edge_px: (own.edge_px || NO_EDGE_PX) * factor(step),
  });
  const { front, silhouette, back } = criteria;
  return { front: stretched(front), silhouette: stretched(silhouette), back: stretched(back) };
}

/** What a view asks of a search. */
export interface Terms {
  /** Triangles at most, 0 for no limit but the device's own. */
  readonly budget: number;
  /** Frames a second, 0 for no such wish. */
  readonly rate: number;
  /** The last step says nothing, so what fits is come to from afar. */
  readonly isLeap: boolean;
}

/**
 * The search for the least step within a budget, from frame to frame: `begin` a view, `tell` the triangles of the
 * step, again and again until `isFit`; then the mesh may be shown. It is the final one when `isSettled`; else
 * `finer` goes on.
 */
export class Pace {
  /** To be tried next; the mesh that may be shown has this one. */
  step = 0;
  readonly #most: number;
  #budget: number;
  readonly #costs: number[] = [];
  #ofRate = Infinity;
  #over = -1;
  #fits = COARSEST + 1;
  #stride = 1;
  #triangles = 0;
  #told = -1;
  /** Of the view before: the step that was too much, what the one shown had, what was allowed. */
  #tried = NOT_TRIED;

  /** @param least - Triangles of the control mesh, which no budget can go below. */
  constructor(
    private readonly least: number,
    budget: number,
  ) {
    this.#most = Math.max(least, budget);
    this.#budget = this.#most;
  }

  begin(criteria: Criteria, { budget, rate, isLeap }: Terms): void {
    if (this.#over >= 0 && this.isFit) {
      this.#tried = { over: this.#over, triangles: this.#triangles, budget: this.#budget };
    }
    const wanted = Math.min(budget || this.#most, this.#most, this.#allowed(rate));
    this.#budget = Math.max(this.least, wanted);
    if (isLeap) {
      this.step = Math.max(this.step, afar(criteria));
      this.#tried = NOT_TRIED;
    }
    this.#over = -1;
    this.#fits = COARSEST + 1;
    this.#stride = 1;
    if (!isLeap && this.isAmple) this.finer(true);
  }

  /** The triangles that a rate allows, by what they cost. */
  #allowed(rate: number): number {
    if (!rate) {
      this.#ofRate = Infinity;
    } else if (this.#costs.length > 0) {
      const allowed = 1000 / rate / median(this.#costs);
      if (!(this.#ofRate / SHIFT < allowed && allowed < this.#ofRate * SHIFT)) this.#ofRate = allowed;
    }
    return Math.floor(Math.min(this.#ofRate, Number.MAX_SAFE_INTEGER));
  }

  /** How many triangles `step` gave, or already has; where they are too many, the next step is a coarser one. */
  tell(triangles: number): void {
    this.#triangles = triangles;
    this.#told = this.step;
    if (triangles <= this.#budget || this.step === COARSEST) {
      this.#fits = Math.min(this.#fits, this.step);
      return;
    }
    this.#over = Math.max(this.#over, this.step);
    if (this.#fits > COARSEST) {
      // Each time twice as far, for views in which the triangles do not change as they should.
      this.step = Math.min(COARSEST, this.step + Math.max(this.#stride, steps(triangles, this.#budget)));
      this.#stride *= 2;
    } else {
      this.step = Math.floor((this.#over + this.#fits + 1) / 2);
    }
  }

  /** Triangles at most, for this view. */
  get budget(): number {
    return this.#budget;
  }

  /** The step last told of is the finest known to be within the budget. */
  get isFit(): boolean {
    return this.step === this.#fits && this.step === this.#told;
  }

  /** That step is the least there is within the budget. */
  get isSettled(): boolean {
    return this.isFit && (this.step === 0 || this.#over === this.step - 1);
  }

  /** A finer step would most likely be within the budget too, as far as the last views tell. */
  get isAmple(): boolean {
    return this.step > this.#leastMoving && this.#triangles * SPARE <= this.#budget;
  }

  /** Try a finer step, by about what the budget leaves; in motion none that was too much just before. */
  finer(isMoving = false): void {
    const down = Math.min(OCTAVE, Math.max(1, steps(this.#budget, this.#triangles)));
    this.step = Math.max(isMoving ? this.#leastMoving : this.#over + 1, this.step - down, 0);
  }

  /** The step to try at most in motion: where many triangles pass a level at once, not the same anew. */
  get #leastMoving(): number {
    const { over, triangles, budget } = this.#tried;
    const hasChanged = this.#triangles < triangles / CHANGE || this.#budget > budget * CHANGE;
    return Math.max(this.#over, hasChanged ? -1 : over) + 1;
  }

  /** What a frame of a moving view cost for each of its triangles, in milliseconds. */
  spent(perTriangle: number): void {
    this.#costs.push(perTriangle);
    if (this.#costs.length > FRAMES) this.#costs.shift();
  }
}

/** Steps by which the triangles change so, as their edges do that fill the picture. */
function steps(many: number, few: number): number {
  return Math.trunc((OCTAVE / 2) * Math.log2(Math.max(1, many) / Math.max(1, few)));
}

/** A step at which no triangle is split for an edge much shorter than 8 pixels. */
function afar(criteria: Criteria): number {
  const edges = REGIONS.map((name) => criteria[name])
    .filter(({ iterations }) => iterations > 0)
    .map(({ edge_px }) => edge_px || NO_EDGE_PX);
  const least = edges.length > 0 ? Math.min(...edges) : AFAR_PX;
  return Math.max(OCTAVE, Math.ceil(OCTAVE * Math.log2(AFAR_PX / least)));
}

function median(values: readonly number[]): number {
  const sorted = values.toSorted((a, b) => a - b);
  const i = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[i]! : (sorted[i - 1]! + sorted[i]!) / 2;
}
