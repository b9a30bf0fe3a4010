/** What the visitor chose of a refinement, in the link as `r`: what is not chosen is as the scene says. */
import type { Positions, Refinement, RegionLimits } from "../format/cage";

/** Null where nothing was chosen. */
export interface RefinementChoice {
  readonly frontIterations: number | null;
  readonly frontPx: number | null;
  readonly silhouetteIterations: number | null;
  readonly silhouettePx: number | null;
  readonly bendDegrees: number | null;
  readonly positions: Positions | null;
}

/** Budget and rate belong to the device that looks, and stay out of links, as the other budgets do. */
export interface DeviceChoice {
  readonly budget: number | null;
  readonly rate: number | null;
}

export const NO_CHOICE: RefinementChoice = {
  frontIterations: null,
  frontPx: null,
  silhouetteIterations: null,
  silhouettePx: null,
  bendDegrees: null,
  positions: null,
};

type NumberKey = Exclude<keyof RefinementChoice, "positions">;

/** Key, least, greatest, whether whole. */
export const RANGES: Readonly<Record<NumberKey, readonly [low: number, high: number, isWhole: boolean]>> = {
  frontIterations: [0, 30, true],
  frontPx: [0, 1000, false],
  silhouetteIterations: [0, 30, true],
  silhouettePx: [0, 1000, false],
  bendDegrees: [0, 180, false],
};

const KEYS = Object.keys(RANGES) as NumberKey[];

/** E.g. `5,,8,,,limit`: in the order above, nothing between commas where nothing was chosen. */
export function formatChoice(choice: RefinementChoice): string {
  const words = KEYS.map((key) => {
    const value = choice[key];
    return value === null ? "" : String(Number(value.toPrecision(4)));
  });
  return [...words, choice.positions ?? ""].join(",").replace(/,+$/, "");
}

/** What such a text says; what it says badly counts as not chosen. */
export function parseChoice(text: string | undefined): RefinementChoice {
  const words = (text ?? "").split(",");
  const number = (key: NumberKey): number | null => {
    const word = words[KEYS.indexOf(key)];
    const [low, high, isWhole] = RANGES[key];
    const value = word ? Number(word) : Number.NaN;
    return value >= low && value <= high && (!isWhole || Number.isInteger(value)) ? value : null;
  };
  const positions = words[KEYS.length];
  return {
    frontIterations: number("frontIterations"),
    frontPx: number("frontPx"),
    silhouetteIterations: number("silhouetteIterations"),
    silhouettePx: number("silhouettePx"),
    bendDegrees: number("bendDegrees"),
    positions: positions === "control" || positions === "limit" ? positions : null,
  };
}

/** The scene's refinement with what was chosen in place of its own. */
export function refinementWith(
  base: Refinement,
  choice: RefinementChoice,
  { budget, rate }: DeviceChoice,
): Refinement {
  const { front, silhouette, back } = base.criteria;
  const region = (own: RegionLimits, iterations: number | null, edgePx: number | null): RegionLimits => ({
    iterations: iterations ?? own.iterations,
    edge_px: edgePx ?? own.edge_px,
    bend: choice.bendDegrees === null ? own.bend : (choice.bendDegrees * Math.PI) / 180,
  });
  return {
    ...base,
    criteria: {
      front: region(front, choice.frontIterations, choice.frontPx),
      silhouette: region(silhouette, choice.silhouetteIterations, choice.silhouettePx),
      back,
    },
    positions: choice.positions ?? base.positions,
    budget: budget ?? base.budget,
    rate: rate ?? base.rate,
  };
}
