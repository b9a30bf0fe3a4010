/** A number that a slider sets. */
import { make } from "./dom";

export interface NumberSetting {
  readonly id: string;
  readonly label: string;
  readonly hint: string;
  readonly low: number;
  readonly high: number;
  /** It runs over the number's logarithm. */
  readonly isLogarithmic: boolean;
  /** Only whole numbers, each its own step. */
  readonly isWhole?: boolean;
  /** Its left end stands for 0, below `low`. */
  readonly hasZero?: boolean;
  readonly show: (value: number) => string;
  readonly get: () => number;
  readonly set: (value: number) => void;
}

/** Few enough that one step is seen in the figures shown. */
const STEPS = 60;

/** The slider with its name, its value in words and a hint; `refreshers` takes what brings it up to date. */
export function makeSlider(setting: NumberSetting, refreshers: (() => void)[]): HTMLElement {
  const input = make("input", {
    type: "range",
    id: `set-${setting.id}`,
    min: "0",
    max: String(stepsOf(setting)),
    step: "1",
  });
  const output = make("output", { for: input.id });
  const hint = make("small", { id: `hint-${setting.id}` }, setting.hint);
  if (setting.hint) input.setAttribute("aria-describedby", hint.id);
  const tell = (value: number): void => {
    output.textContent = setting.show(value);
    input.setAttribute("aria-valuetext", setting.show(value));
  };
  input.addEventListener("input", () => {
    const value = valueAt(setting, Number(input.value));
    setting.set(value);
    tell(value);
  });
  refreshers.push(() => {
    const value = setting.get();
    input.value = String(positionOf(setting, value));
    tell(value);
  });
  const label = make("label", { for: input.id }, setting.label);
  return make("div", { class: "setting" }, label, output, input, ...(setting.hint ? [hint] : []));
}

function stepsOf({ low, high, isWhole }: NumberSetting): number {
  return isWhole ? high - low : STEPS;
}

/** Where the slider stands for a value, from 0. */
export function positionOf(setting: NumberSetting, value: number): number {
  const { low, high, isLogarithmic, hasZero } = setting;
  const steps = stepsOf(setting);
  const first = hasZero ? 1 : 0;
  if (hasZero && value < low) return 0;
  const share = isLogarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return first + Math.round(Math.min(1, Math.max(0, share)) * (steps - first));
}

/** The value where the slider stands, in two or three figures or whole. */
export function valueAt(setting: NumberSetting, position: number): number {
  const { low, high, isLogarithmic, isWhole, hasZero } = setting;
  const first = hasZero ? 1 : 0;
  if (position < first) return 0;
  const share = (position - first) / (stepsOf(setting) - first);
  const value = isLogarithmic ? low * (high / low) ** share : low + (high - low) * share;
  return isWhole ? Math.round(value) : Number(value.toPrecision(isLogarithmic ? 2 : 3));
}
