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
  const hasNoPatches = (): boolean =>
    app.stage.layers.length > 0 && !app.stage.layers.some((layer) => layer.hasPatches);
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
    { icon: "patches", key: "P", ...flag("arePatchesTinted", WORDS.patches), isAbsent: hasNoPatches },
    { icon: "spheres", key: "B", ...flag("areSpheresOn", WORDS.spheres), isAbsent: hasNoPatches },
    ...refinementTools(app),
    {
      icon: "light",
      name: WORDS.light,
      key: "D",
      isAbsent: () => !app.light,
      isPressed: () => app.state.light.isOn,
      run: () => app.light?.openPanel(),
    },
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

/** Of what is refined where it is looked at; there is none before the scene is open. */
function refinementTools(app: App): Tool[] {
  const isAbsent = (): boolean => !app.refinement;
  const say = (name: string, isOn: boolean): void => announce(isOn ? WORDS.on(name) : WORDS.off(name));
  return [
    {
      icon: "levels",
      name: WORDS.faceColours,
      key: "M",
      isAbsent,
      isPressed: () => app.state.faceColours !== "plain",
      run: () => {
        app.change({ faceColours: app.state.faceColours === "plain" ? "levels" : "plain" });
        say(WORDS.faceColours, app.state.faceColours !== "plain");
      },
    },
    {
      icon: "inset",
      name: WORDS.inset,
      key: "E",
      isAbsent,
      isPressed: () => app.refinement?.isInsetOn ?? false,
      run: () => {
        app.refinement?.toggleInset();
        say(WORDS.inset, app.refinement?.isInsetOn ?? false);
      },
    },
    {
      icon: "refinement",
      name: WORDS.refinement,
      key: "R",
      isAbsent,
      run: () => app.refinement?.openPanel(),
    },
  ];
}
