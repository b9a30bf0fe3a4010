/** What the visitor chose of a scene's light, in the link as `h`: what is not chosen is as the scene has it. */
import { SHADOW_FILTERS, type ShadowFilter } from "../scene/light/look";

export interface LightChoice {
  /** Else the light hangs on the camera, as in a scene without one. */
  readonly isOn: boolean;
  /** Null for what suits the light. */
  readonly filter: ShadowFilter | null;
  /** Of a sun's path, minutes of its day. Null for its middle. */
  readonly minutes: number | null;
}

export const NO_LIGHT_CHOICE: LightChoice = { isOn: true, filter: null, minutes: null };

const OFF = "off";
/** Three days: a path may go on after midnight. */
const MOST_MINUTES = 3 * 24 * 60;

/** E.g. `off`, `5x5` or `hard,14:30`. */
export function formatLight({ isOn, filter, minutes }: LightChoice): string {
  const words = [isOn ? "" : OFF, filter ?? "", minutes === null ? "" : clockOf(minutes)];
  return words.filter((word) => word).join(",");
}

/** What such a text says; what it says badly counts as not chosen. */
export function parseLightChoice(text: string | undefined): LightChoice {
  const words = (text ?? "").split(",");
  const clock = words.map(minutesOf).find((minutes) => minutes !== null);
  return {
    isOn: !words.includes(OFF),
    filter: SHADOW_FILTERS.find((filter) => words.includes(filter)) ?? null,
    minutes: clock ?? null,
  };
}

/** Minutes of a day as its clock shows them; 1470 is 24:30, half past midnight. */
export function clockOf(minutes: number): string {
  const whole = Math.round(minutes);
  return `${String(Math.floor(whole / 60)).padStart(2, "0")}:${String(whole % 60).padStart(2, "0")}`;
}

function minutesOf(word: string): number | null {
  const [, hours, minutes] = /^(\d\d):([0-5]\d)$/.exec(word) ?? [];
  if (hours === undefined || minutes === undefined) return null;
  const all = 60 * Number(hours) + Number(minutes);
  return all < MOST_MINUTES ? all : null;
}

/** The image of a path at this time, between two of them in proportion. */
export function imageAt(times: readonly number[], minutes: number): number {
  const next = times.findIndex((time) => time >= minutes);
  if (next <= 0) return next === 0 ? 0 : times.length - 1;
  const [before, after] = [times[next - 1]!, times[next]!];
  return next - 1 + (minutes - before) / (after - before);
}
