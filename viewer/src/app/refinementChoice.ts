/** What the visitor chose of a refinement, in the link as `r`: what is not chosen is as the scene says. */
import {
  type DepthRules,
  MOST_DEPTH,
  type Positions,
  type Refinement,
  type RegionLimits,
} from "../format/cage";

/** Null where nothing was chosen. */
export interface RefinementChoice {
  readonly frontIterations: number | null;
  readonly frontPx: number | null;
  readonly silhouetteIterations: number | null;
  readonly silhouettePx: number | null;
  readonly bendDegrees: number | null;
  readonly positions: Positions | null;
  /** Largest radius of a piece of a patch. */
  readonly radiusPx: number | null;
  /** The rules for the depth of patches that hold, all others being left out. */
  readonly rules: readonly Rule[] | null;
}

/** In the link by their first letters. */
export const RULES = ["curvature", "backs", "silhouettes", "size"] as const;
export type Rule = (typeof RULES)[number];

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
  radiusPx: null,
  rules: null,
};

type NumberKey = Exclude<keyof RefinementChoice, "positions" | "radiusPx" | "rules">;

/** Key, least, greatest, whether whole. */
export const RANGES: Readonly<Record<NumberKey, readonly [low: number, high: number, isWhole: boolean]>> = {
  frontIterations: [0, 30, true],
  frontPx: [0, 1000, false],
  silhouetteIterations: [0, 30, true],
  silhouettePx: [0, 1000, false],
  bendDegrees: [0, 180, false],
};

const KEYS = Object.keys(RANGES) as NumberKey[];

const RADII = [0.01, 10_000] as const;
const NO_RULES = "-";

/** E.g. `5,,8,,,limit,12,cs`: in the order above, nothing between commas where nothing was chosen. */
export function formatChoice(choice: RefinementChoice): string {
  const short = (value: number | null): string =>
    value === null ? "" : String(Number(value.toPrecision(4)));
  const words = KEYS.map((key) => short(choice[key]));
  const rules = choice.rules && (choice.rules.map(letterOf).join("") || NO_RULES);
  return [...words, choice.positions ?? "", short(choice.radiusPx), rules ?? ""].join(",").replace(/,+$/, "");
}

/** c, b, s, and z of size. */
function letterOf(rule: Rule): string {
  return rule === "size" ? "z" : rule[0]!;
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
  const [positions, radius, letters] = words.slice(KEYS.length);
  const radiusPx = radius ? Number(radius) : Number.NaN;
  return {
    frontIterations: number("frontIterations"),
    frontPx: number("frontPx"),
    silhouetteIterations: number("silhouetteIterations"),
    silhouettePx: number("silhouettePx"),
    bendDegrees: number("bendDegrees"),
    positions: positions === "control" || positions === "limit" ? positions : null,
    radiusPx: radiusPx >= RADII[0] && radiusPx <= RADII[1] ? radiusPx : null,
    rules: letters ? RULES.filter((rule) => letters.includes(letterOf(rule))) : null,
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
    depths: depthsWith(base.depths, choice),
    positions: choice.positions ?? base.positions,
    budget: budget ?? base.budget,
    rate: rate ?? base.rate,
  };
}

/** What a rule says where the scene leaves it out and the visitor does not. */
const USUAL = { cone: 8, size: [3, 24] } as const;

/** Maximum depth and cone are what front faces call iterations and bend. */
function depthsWith(own: DepthRules, choice: RefinementChoice): DepthRules {
  const holds = (rule: Rule, is: boolean): boolean => (choice.rules ? choice.rules.includes(rule) : is);
  const cone = choice.bendDegrees ?? own.cone_degrees ?? USUAL.cone;
  const [least, most] = own.size_px ?? USUAL.size;
  const radius = choice.radiusPx ?? most;
  return {
    ...own,
    most: Math.min(MOST_DEPTH, choice.frontIterations ?? own.most),
    cone_degrees: holds("curvature", own.cone_degrees !== null) && cone > 0 ? cone : null,
    backs: holds("backs", own.backs),
    silhouettes: holds("silhouettes", own.silhouettes),
    size_px: holds("size", own.size_px !== null) ? [(least * radius) / most, radius] : null,
  };
}

/** The rules that hold. */
export function rulesOf({ cone_degrees, backs, silhouettes, size_px }: DepthRules): Rule[] {
  const is = { curvature: cone_degrees !== null, backs, silhouettes, size: size_px !== null };
  return RULES.filter((rule) => is[rule]);
}
