/** The sheet of settings: what the picture may cost, and how it is seen. */
import { makeDialog } from "./dialogs";
import { make } from "./dom";
import { BACKGROUNDS, type BackgroundName } from "./state";
import { WORDS } from "./words";

/** A number that a slider sets; the slider runs over its logarithm where `isLogarithmic`. */
export interface NumberSetting {
  readonly id: string;
  readonly label: string;
  readonly hint: string;
  readonly low: number;
  readonly high: number;
  readonly isLogarithmic: boolean;
  readonly show: (value: number) => string;
  readonly get: () => number;
  readonly set: (value: number) => void;
}

export interface LayerSetting {
  readonly name: string;
  readonly get: () => boolean;
  readonly set: (isVisible: boolean) => void;
}

export interface SettingsOptions {
  readonly numbers: readonly NumberSetting[];
  readonly layers: readonly LayerSetting[];
  readonly getBackground: () => BackgroundName;
  readonly setBackground: (name: BackgroundName) => void;
  readonly reset: () => void;
}

/** Few enough that one step is seen in the figures shown. */
const STEPS = 60;

export function makeSettings(options: SettingsOptions): HTMLDialogElement {
  const { dialog, body } = makeDialog("settings", WORDS.settings);
  const refreshers: (() => void)[] = [];
  for (const setting of options.numbers) body.append(makeSlider(setting, refreshers));
  body.append(makeBackground(options, refreshers));
  if (options.layers.length > 1) body.append(makeLayers(options.layers, refreshers));
  const reset = make("button", { type: "button" }, "Back to this device's own");
  reset.addEventListener("click", () => {
    options.reset();
    for (const refresh of refreshers) refresh();
  });
  body.append(reset);
  const show = dialog.showModal.bind(dialog);
  dialog.showModal = () => {
    for (const refresh of refreshers) refresh();
    show();
  };
  return dialog;
}

function makeSlider(setting: NumberSetting, refreshers: (() => void)[]): HTMLElement {
  const input = make("input", {
    type: "range",
    id: `set-${setting.id}`,
    min: "0",
    max: String(STEPS),
    step: "1",
  });
  const output = make("output", { for: input.id });
  const hint = make("small", { id: `hint-${setting.id}` }, setting.hint);
  input.setAttribute("aria-describedby", hint.id);
  const refresh = (): void => {
    const value = setting.get();
    input.value = String(positionOf(setting, value));
    tell(value);
  };
  const tell = (value: number): void => {
    output.textContent = setting.show(value);
    input.setAttribute("aria-valuetext", setting.show(value));
  };
  input.addEventListener("input", () => {
    const value = valueAt(setting, Number(input.value));
    setting.set(value);
    tell(value);
  });
  refreshers.push(refresh);
  const label = make("label", { for: input.id }, setting.label);
  return make("div", { class: "setting" }, label, output, input, hint);
}

/** Where the slider stands for a value, 0 to STEPS. */
export function positionOf({ low, high, isLogarithmic }: NumberSetting, value: number): number {
  const share = isLogarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(Math.min(1, Math.max(0, share)) * STEPS);
}

/** The value where the slider stands, in two or three figures. */
export function valueAt({ low, high, isLogarithmic }: NumberSetting, position: number): number {
  const share = position / STEPS;
  const value = isLogarithmic ? low * (high / low) ** share : low + (high - low) * share;
  return Number(value.toPrecision(isLogarithmic ? 2 : 3));
}

function makeBackground(options: SettingsOptions, refreshers: (() => void)[]): HTMLElement {
  const names: Record<BackgroundName, string> = {
    auto: "As the page",
    white: "White",
    grey: "Grey",
    black: "Black",
  };
  const select = make("select", { id: "set-background" });
  for (const name of BACKGROUNDS) select.append(make("option", { value: name }, names[name]));
  select.addEventListener("change", () => options.setBackground(select.value as BackgroundName));
  refreshers.push(() => {
    select.value = options.getBackground();
  });
  return make("div", { class: "setting" }, make("label", { for: select.id }, "Background"), select);
}

function makeLayers(layers: readonly LayerSetting[], refreshers: (() => void)[]): HTMLElement {
  const group = make("fieldset", {}, make("legend", {}, "Layers"));
  for (const layer of layers) {
    const box = make("input", { type: "checkbox" });
    box.addEventListener("change", () => layer.set(box.checked));
    refreshers.push(() => {
      box.checked = layer.get();
    });
    group.append(make("label", {}, box, layer.name));
  }
  return group;
}
