/** The sheet of settings: what the picture may cost, and how it is seen. */
import { Sheet, type Switch } from "./sheet";
import type { NumberSetting } from "./slider";
import type { BackgroundName } from "./state";
import { WORDS } from "./words";

export interface SettingsOptions {
  readonly numbers: readonly NumberSetting[];
  readonly layers: readonly Switch[];
  readonly getBackground: () => BackgroundName;
  readonly setBackground: (name: BackgroundName) => void;
  readonly reset: () => void;
}

export function makeSettings(options: SettingsOptions): Sheet {
  const sheet = new Sheet("settings", WORDS.settings);
  for (const setting of options.numbers) sheet.addSlider(setting);
  sheet.addSelection({
    id: "background",
    label: "Background",
    options: [
      ["auto", "As the page"],
      ["white", "White"],
      ["grey", "Grey"],
      ["black", "Black"],
    ],
    get: options.getBackground,
    set: options.setBackground,
  });
  if (options.layers.length > 1) sheet.addSwitches("Layers", options.layers);
  sheet.addReset("Back to this device's own", options.reset);
  return sheet;
}
