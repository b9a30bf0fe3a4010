/** What the toolbar offers; each has a letter that does the same. */
import type { App } from "./app";
import { announce } from "./notices";
import type { State } from "./state";
import type { Tool } from "./toolbar";
import { WORDS } from "./words";

type Flag = "areColoursOn" | "isWireframe" | "arePatchesTinted" | "areSpheresOn" | "isStatusOn";

export function makeTools(app: App): Tool[] {
  const flag = (key: Flag, name: string): Pick<Tool, "name" | "run" | "isPressed"> => ({
    name,
    isPressed: () => app.state[key],
    run: () => {
      const isOn = !app.state[key];
      app.change({ [key]: isOn } as Partial<State>);
      announce(isOn ? WORDS.on(name) : WORDS.off(name));
    },
  });
  const canFill = document.fullscreenEnabled;
  return [
    { icon: "home", name: WORDS.home, key: "F", run: () => app.home() },
    {
      icon: "upAxis",
      name: WORDS.upAxis(""),
      key: "U",
      run: () => app.turnUp(),
      label: () => WORDS.upAxis(app.upName().toUpperCase()),
      badge: () => app.upName(),
    },
    {
      icon: "colours",
      key: "C",
      startsGroup: true,
      ...flag("areColoursOn", WORDS.colours),
      isDisabled: () => !app.stage.layers.some((layer) => layer.hasColours),
    },
    { icon: "wireframe", key: "W", ...flag("isWireframe", WORDS.wireframe) },
    { icon: "patches", key: "P", ...flag("arePatchesTinted", WORDS.patches) },
    { icon: "spheres", key: "B", ...flag("areSpheresOn", WORDS.spheres) },
    {
      icon: "screenshot",
      name: WORDS.screenshot,
      key: "S",
      startsGroup: true,
      run: () => void app.savePicture(),
    },
    { icon: "share", name: WORDS.share, key: "L", run: () => void app.copyLink() },
    ...(canFill
      ? [
          {
            icon: "fullscreen" as const,
            name: WORDS.fullscreen,
            key: "X",
            isPressed: () => document.fullscreenElement !== null,
            run: () => void app.toggleFullscreen(),
          },
        ]
      : []),
    { icon: "settings", name: WORDS.settings, key: "O", startsGroup: true, run: () => app.openSettings() },
    { icon: "theme", name: WORDS.theme, key: "T", run: () => app.toggleTheme() },
    { icon: "status", key: "I", ...flag("isStatusOn", WORDS.status) },
    { icon: "help", name: WORDS.help, key: "H", run: () => app.help.showModal() },
  ];
}
