/** The settings of this viewer: budgets, error, view, background, layers. */
import { defaultBudgets, deviceHints } from "../scene/device";
import type { App } from "./app";
import type { SettingsOptions } from "./settings";
import { INITIAL } from "./state";

/** All that can be set, and what the device would choose. */
export function settingsOf(app: App): SettingsOptions {
  const { stage } = app;
  const own = defaultBudgets(deviceHints());
  const million = (value: number): string => `${Number((value / 1e6).toPrecision(2))} million`;
  return {
    numbers: [
      {
        id: "error",
        label: "Error",
        hint: "Smaller is finer and costs more.",
        low: 0.5,
        high: 16,
        isLogarithmic: true,
        show: (value) => `${value} px`,
        get: () => stage.targetPx,
        set: (errorPx) => app.setErrorPx(errorPx),
      },
      {
        id: "triangles",
        label: "Triangles at most",
        hint: "What the graphics draw in one picture.",
        low: 1e5,
        high: 2e7,
        isLogarithmic: true,
        show: million,
        get: () => stage.triangleBudget,
        set: (triangles) => app.setBudgets({ triangles }),
      },
      {
        id: "memory",
        label: "Memory at most",
        hint: "Graphics memory for what is loaded.",
        low: 32,
        high: 4096,
        isLogarithmic: true,
        show: (value) => `${Math.round(value)} MB`,
        get: () => app.stats().memoryBudgetBytes / 2 ** 20,
        set: (mega) => app.setBudgets({ bytes: mega * 2 ** 20 }),
      },
      {
        id: "view",
        label: "Field of view",
        hint: "Vertical angle; small is like a long lens.",
        low: 10,
        high: 90,
        isLogarithmic: false,
        show: (value) => `${Math.round(value)}°`,
        get: () => stage.navigation.camera.fov,
        set: (degrees) => {
          stage.navigation.setFieldOfView(Math.round(degrees));
          stage.invalidate();
        },
      },
    ],
    layers: stage.layers.map((layer, i) => ({
      name: layer.name,
      get: () => layer.group.visible,
      set: () => app.toggleLayer(i),
    })),
    getBackground: () => app.state.background,
    setBackground: (background) => app.change({ background }),
    reset: () => {
      app.setBudgets({ triangles: own.triangles, bytes: own.bytes });
      app.change({ errorPx: null, background: INITIAL.background });
    },
  };
}
