/** Dark and light, and the background that goes with them. */
import type { BackgroundColours } from "../scene/background";
import type { BackgroundName, ThemeName } from "./state";

const GRADIENTS: Readonly<Record<"light" | "dark" | Exclude<BackgroundName, "auto">, BackgroundColours>> = {
  light: { middle: "#fbf9f5", corners: "#d9d3c8" },
  dark: { middle: "#33353a", corners: "#101114" },
  white: { middle: "#ffffff", corners: "#ffffff" },
  grey: { middle: "#8c8c8c", corners: "#6b6b6b" },
  black: { middle: "#000000", corners: "#000000" },
};

const darkQuery = matchMedia("(prefers-color-scheme: dark)");

/** What a theme comes to on this device. */
export function resolveTheme(theme: ThemeName): "light" | "dark" {
  if (theme !== "auto") return theme;
  return darkQuery.matches ? "dark" : "light";
}

export function onDeviceTheme(listener: () => void): void {
  darkQuery.addEventListener("change", listener);
}

/** @param own - The scene's own colour, `#rrggbb`, which rules where the visitor chose none. */
export function backgroundOf(name: BackgroundName, theme: ThemeName, own: string | null): BackgroundColours {
  if (name !== "auto") return GRADIENTS[name];
  if (own !== null && /^#[0-9a-f]{6}$/i.test(own)) return { middle: own, corners: own };
  return GRADIENTS[resolveTheme(theme)];
}

export function applyTheme(theme: ThemeName): void {
  document.documentElement.dataset.theme = resolveTheme(theme);
}
