/**
 * All that a link holds, in the address after `#`: short keys, few digits, a version; unknown keys are ignored.
 *
 * Budgets are left out on purpose: they belong to the device that looks, not to what is looked at, and a
 * workstation's would end a phone's tab.
 */
import type { Triple } from "../format/graph";
import { FACE_COLOURS, type FaceColours } from "../scene/layer";
import type { CameraState } from "../scene/navigation";
import { FIRST_TURN, type Turn, turned } from "../scene/turn";
import { formatLight, type LightChoice, NO_LIGHT_CHOICE, parseLightChoice } from "./lightChoice";
import { formatChoice, NO_CHOICE, parseChoice, type RefinementChoice } from "./refinementChoice";

export const BACKGROUNDS = ["auto", "white", "grey", "black"] as const;
export type BackgroundName = (typeof BACKGROUNDS)[number];

export const THEMES = ["auto", "light", "dark"] as const;
export type ThemeName = (typeof THEMES)[number];

export interface State {
  readonly camera: CameraState | null;
  readonly areColoursOn: boolean;
  readonly isWireframe: boolean;
  readonly arePatchesTinted: boolean;
  readonly areSpheresOn: boolean;
  readonly isStatusOn: boolean;
  /** Null for the device's own. */
  readonly errorPx: number | null;
  readonly background: BackgroundName;
  readonly theme: ThemeName;
  /** Numbers of the layers whose visibility differs from the scene's. */
  readonly toggledLayers: readonly number[];
  /** Of what is refined where it is looked at. */
  readonly faceColours: FaceColours;
  readonly refinement: RefinementChoice;
  /** Null for what suits the device. */
  readonly isInsetOn: boolean | null;
  readonly insetTurn: Turn;
  /** Of a scene's own light. */
  readonly light: LightChoice;
}

export const INITIAL: State = {
  camera: null,
  areColoursOn: true,
  isWireframe: false,
  arePatchesTinted: false,
  areSpheresOn: false,
  isStatusOn: true,
  errorPx: null,
  background: "auto",
  theme: "auto",
  toggledLayers: [],
  faceColours: "plain",
  refinement: NO_CHOICE,
  isInsetOn: null,
  insetTurn: FIRST_TURN,
  light: NO_LIGHT_CHOICE,
};

const VERSION = "1";
const DIGITS = 6;

/** The fragment without `#`. What is as it is at first is left out. */
export function formatState(state: State): string {
  const parts: [string, string][] = [["v", VERSION]];
  if (state.camera) parts.push(...cameraParts(state.camera));
  const flag = (key: string, value: boolean, initial: boolean): void => {
    if (value !== initial) parts.push([key, value ? "1" : "0"]);
  };
  flag("k", state.areColoursOn, INITIAL.areColoursOn);
  flag("w", state.isWireframe, INITIAL.isWireframe);
  flag("p", state.arePatchesTinted, INITIAL.arePatchesTinted);
  flag("s", state.areSpheresOn, INITIAL.areSpheresOn);
  flag("i", state.isStatusOn, INITIAL.isStatusOn);
  if (state.errorPx !== null) parts.push(["e", shortest(state.errorPx)]);
  if (state.background !== INITIAL.background) parts.push(["b", state.background]);
  if (state.theme !== INITIAL.theme) parts.push(["t", state.theme]);
  if (state.toggledLayers.length) parts.push(["l", state.toggledLayers.join(",")]);
  parts.push(...refinementParts(state));
  const light = formatLight(state.light);
  if (light) parts.push(["h", light]);
  return parts.map(([key, value]) => `${key}=${value}`).join("&");
}

function refinementParts(state: State): [string, string][] {
  const { faceColours, refinement, isInsetOn, insetTurn } = state;
  const parts: [string, string][] = [];
  if (faceColours !== INITIAL.faceColours) parts.push(["m", faceColours]);
  const choice = formatChoice(refinement);
  if (choice) parts.push(["r", choice]);
  if (isInsetOn !== null) parts.push(["n", isInsetOn ? "1" : "0"]);
  const turn = insetTurn.map(Math.round).join(",");
  if (turn !== INITIAL.insetTurn.join(",")) parts.push(["o", turn]);
  return parts;
}

function cameraParts({ position, target, up, fieldOfViewDegrees }: CameraState): [string, string][] {
  // a hundred-thousandth of the distance to the target is below a tenth of a pixel, whatever the coordinates
  const distance = Math.hypot(...position.map((p, a) => p - target[a]!));
  const decimals = Math.max(0, Math.min(15, 5 - Math.floor(Math.log10(distance || 1))));
  const numbers = [...position, ...target].map((x) => trimmed(x.toFixed(decimals)));
  const axis = (["x", "y", "z"] as const).find((_, a) => up[a] === 1);
  return [
    ["c", numbers.join(",")],
    ["u", axis ?? up.map(shortest).join(",")],
    ["f", shortest(fieldOfViewDegrees)],
  ];
}

function shortest(value: number): string {
  return String(Number(value.toPrecision(DIGITS)));
}

function trimmed(fixed: string): string {
  const short = fixed.includes(".") ? fixed.replace(/\.?0+$/, "") : fixed;
  return short === "-0" ? "0" : short;
}

/** What a fragment says; what it does not say, or says badly, is as at first. Null if it is of no known version. */
export function parseState(fragment: string): State | null {
  const keys = new Map<string, string>();
  for (const part of fragment.replace(/^#/, "").split("&")) {
    const at = part.indexOf("=");
    if (at > 0) keys.set(part.slice(0, at), part.slice(at + 1));
  }
  if (keys.get("v") !== VERSION) return null;
  const flag = (key: string, initial: boolean): boolean => {
    const value = keys.get(key);
    return value === "1" ? true : value === "0" ? false : initial;
  };
  return {
    camera: cameraOf(keys),
    areColoursOn: flag("k", INITIAL.areColoursOn),
    isWireframe: flag("w", INITIAL.isWireframe),
    arePatchesTinted: flag("p", INITIAL.arePatchesTinted),
    areSpheresOn: flag("s", INITIAL.areSpheresOn),
    isStatusOn: flag("i", INITIAL.isStatusOn),
    errorPx: within(keys.get("e"), 0.1, 100),
    background: oneOf(BACKGROUNDS, keys.get("b")),
    theme: oneOf(THEMES, keys.get("t")),
    toggledLayers: layersOf(keys.get("l")),
    faceColours: oneOf(FACE_COLOURS, keys.get("m")),
    refinement: parseChoice(keys.get("r")),
    isInsetOn: keys.has("n") ? flag("n", true) : null,
    insetTurn: turnOf(keys.get("o")),
    light: parseLightChoice(keys.get("h")),
  };
}

function cameraOf(keys: ReadonlyMap<string, string>): CameraState | null {
  const numbers = numbersOf(keys.get("c"));
  if (numbers?.length !== 6) return null;
  const position = numbers.slice(0, 3) as unknown as Triple;
  const target = numbers.slice(3) as unknown as Triple;
  if (position.every((p, a) => p === target[a])) return null;
  return {
    position,
    target,
    up: upOf(keys.get("u")),
    fieldOfViewDegrees: within(keys.get("f"), 5, 120) ?? 40,
  };
}

function turnOf(text: string | undefined): Turn {
  const numbers = numbersOf(text);
  if (numbers?.length !== 2) return INITIAL.insetTurn;
  return turned(numbers as unknown as Turn, 0, 0);
}

function upOf(text: string | undefined): Triple {
  if (text === "x") return [1, 0, 0];
  if (text === "z") return [0, 0, 1];
  const numbers = numbersOf(text);
  return numbers?.length === 3 && Math.hypot(...numbers) > 0 ? (numbers as unknown as Triple) : [0, 1, 0];
}

function numbersOf(text: string | undefined): number[] | null {
  if (!text) return null;
  const numbers = text.split(",").map((word) => (word.trim() === "" ? Number.NaN : Number(word)));
  return numbers.every(Number.isFinite) ? numbers : null;
}

function within(text: string | undefined, low: number, high: number): number | null {
  const value = text === undefined || text === "" ? Number.NaN : Number(text);
  return value >= low && value <= high ? value : null;
}

function oneOf<T extends string>(names: readonly [T, ...T[]], text: string | undefined): T {
  return names.find((name) => name === text) ?? names[0];
}

function layersOf(text: string | undefined): number[] {
  return (numbersOf(text) ?? []).filter((n) => Number.isInteger(n) && n >= 0 && n < 1000);
}
