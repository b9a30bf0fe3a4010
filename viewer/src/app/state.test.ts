import { describe, expect, it } from "vitest";
import { isField, pressKey } from "./keys";
import { NO_LIGHT_CHOICE } from "./lightChoice";
import { NO_CHOICE } from "./refinementChoice";
import { fetchScene, parseScene } from "./sceneFile";
import { fileName } from "./sharing";
import { positionOf, valueAt } from "./slider";
import { formatState, INITIAL, parseState, type State } from "./state";
import { directionWords } from "./words";

const CAMERA = {
  position: [1.5, -2.25, 3],
  target: [0, 0.5, 0],
  up: [0, 0, 1],
  fieldOfViewDegrees: 37.5,
} as const;

describe("address", () => {
  const CASES: { [K in keyof State]-?: State[K][] } = {
    camera: [
      null,
      CAMERA,
      { ...CAMERA, up: [0, 1, 0] },
      { ...CAMERA, up: [1, 0, 0] },
      { ...CAMERA, up: [0.6, 0, 0.8] },
    ],
    areColoursOn: [true, false],
    isWireframe: [true, false],
    arePatchesTinted: [true, false],
    areSpheresOn: [true, false],
    isStatusOn: [true, false],
    errorPx: [null, 0.5, 1, 2.75, 16],
    background: ["auto", "white", "grey", "black"],
    theme: ["auto", "light", "dark"],
    toggledLayers: [[], [0], [1, 12]],
    faceColours: ["plain", "levels", "triplet"],
    refinement: [
      NO_CHOICE,
      { ...NO_CHOICE, bendDegrees: 7.5 },
      { ...NO_CHOICE, frontIterations: 3, positions: "limit" },
      { ...NO_CHOICE, radiusPx: 12.5, rules: ["curvature", "size"] },
      { ...NO_CHOICE, rules: [] },
    ],
    isInsetOn: [null, true, false],
    insetTurn: [
      [150, 35],
      [-90, -12],
    ],
    light: [
      NO_LIGHT_CHOICE,
      { ...NO_LIGHT_CHOICE, isOn: false },
      { isOn: true, filter: "5x5", minutes: 870 },
      { isOn: false, filter: "hard", minutes: 1470 },
    ],
  };

  for (const key of Object.keys(CASES) as (keyof State)[]) {
    it(`brings back ${key}`, () => {
      for (const value of CASES[key]) {
        const state = { ...INITIAL, [key]: value } as State;
        expect(parseState(`#${formatState(state)}`)).toEqual(state);
      }
    });
  }

  it("brings back all at once, and is short", () => {
    const state = Object.fromEntries(
      Object.entries(CASES).map(([key, values]) => [key, values.at(-1)]),
    ) as unknown as State;
    expect(parseState(formatState(state))).toEqual(state);
    expect(formatState(state).length).toBeLessThan(160);
    expect(formatState(INITIAL)).toBe("v=1");
  });

  it("keeps a camera to a tenth of a pixel at every size and place", () => {
    for (const size of [1e-6, 1e-3, 1, 1e3, 1e6]) {
      for (const far of [0, 500_000, 4_800_000]) {
        if (far / size > 1e12) continue; // beyond what doubles hold
        const position = [far + 0.31234567 * size, 1.7654321 * size, 2.1111111 * size] as const;
        const target = [far + 0.1234567 * size, 0, 0.7654321 * size] as const;
        const back = parseState(formatState({ ...INITIAL, camera: { ...CAMERA, position, target } }))?.camera;
        const distance = Math.hypot(...position.map((x, a) => x - target[a]!));
        back?.position.forEach((x, a) => {
          expect(Math.abs(x - position[a]!)).toBeLessThanOrEqual(Math.max(1e-5 * distance, 1e-9 * far));
        });
        expect(back).toBeTruthy();
      }
    }
  });

  it("ignores unknown keys and nonsense, and knows versions", () => {
    expect(parseState("#v=1&zz=9&w=1&&=&q")).toEqual({ ...INITIAL, isWireframe: true });
    expect(parseState("#v=1&c=1,2,3&w=yes&e=-4&b=pink&t=&l=a,b&f=900")).toEqual(INITIAL);
    expect(parseState("#v=1&c=1,2,3,1,2,3")).toEqual(INITIAL);
    expect(parseState("#v=1&c=1,2,3,4,5,NaN")).toEqual(INITIAL);
    expect(parseState("#v=2&w=1")).toBeNull();
    expect(parseState("#chapter")).toBeNull();
  });
});

describe("keys", () => {
  function press(event: Partial<KeyboardEvent>): string[] {
    const done: string[] = [];
    const log =
      (name: string) =>
      (...values: unknown[]): true => {
        done.push([name, ...values].join(" "));
        return true;
      };
    const actions = {
      orbit: log("orbit"),
      pan: log("pan"),
      zoom: log("zoom"),
      view: log("view"),
      tool: log("tool"),
    };
    const base = { code: "", key: "", shiftKey: false, ctrlKey: false, altKey: false, metaKey: false };
    const isDone = pressKey({ ...base, ...event }, actions);
    expect(isDone).toBe(done.length > 0);
    return done;
  }

  it("goes by the place of a key", () => {
    expect(press({ code: "ArrowLeft" })).toEqual(["orbit -10 0"]);
    expect(press({ code: "ArrowUp", shiftKey: true })).toEqual(["pan 0 0.08"]);
    expect(press({ code: "Equal" })).toEqual(["zoom 1.25"]);
    expect(press({ code: "NumpadSubtract" })).toEqual(["zoom 0.8"]);
    expect(press({ code: "Slash", key: "+" })).toEqual(["zoom 1.25"]);
    expect(press({ code: "KeyW", key: "z" })).toEqual(["tool W"]);
    expect(press({ code: "Home" })).toEqual(["tool F"]);
    expect(press({ code: "Digit3" })).toEqual(["view 3"]);
    expect(press({ code: "Minus", key: "?", shiftKey: true })).toEqual(["zoom 0.8"]);
    expect(press({ code: "Slash", key: "?", shiftKey: true })).toEqual(["tool H"]);
  });

  it("leaves the browser's own alone", () => {
    expect(press({ code: "KeyW", ctrlKey: true })).toEqual([]);
    expect(press({ code: "KeyF", metaKey: true })).toEqual([]);
    expect(press({ code: "ArrowLeft", altKey: true })).toEqual([]);
    expect(press({ code: "Tab" })).toEqual([]);
    expect(isField.length).toBe(1);
  });
});

describe("scene file", () => {
  const URL_ = "http://127.0.0.1:8000/scene.json";
  const LAYER = { name: "Statue", asset: "data/statue.fov" };

  it("is read with its defaults", () => {
    const scene = parseScene({ version: 1, layers: [LAYER] }, URL_);
    expect(scene).toMatchObject({ title: "Statue", views: [], background: null });
    expect(scene.layers[0]).toEqual({
      name: "Statue",
      url: "http://127.0.0.1:8000/data/statue.fov",
      isVisible: true,
      live: null,
      rest: LAYER,
    });
  });

  it("leaves out views that make no sense", () => {
    const camera = { position: [1, 2, 3], target: [0, 0, 0], up: [0, 0, 1], field_of_view_degrees: 30 };
    const views = [{ name: "Front", camera }, { name: "Odd", camera: { position: [1] } }, null, { camera }];
    const scene = parseScene({ version: 1, layers: [LAYER], views }, URL_);
    expect(scene.views.map(({ name }) => name)).toEqual(["Front"]);
    expect(scene.views[0]!.camera).toEqual({
      position: [1, 2, 3],
      target: [0, 0, 0],
      up: [0, 0, 1],
      fieldOfViewDegrees: 30,
    });
  });

  it("is refused with a sentence", () => {
    for (const data of [null, 3, [], {}, { version: 1, layers: [] }, { version: 1, layers: [{}] }]) {
      expect(() => parseScene(data, URL_)).toThrow(/^scene.json/);
    }
    expect(() => parseScene({ version: 7, layers: [LAYER] }, URL_)).toThrow(/version 7/);
    expect(fetchScene.length).toBe(1);
  });
});

describe("words and numbers", () => {
  it("says from where one looks", () => {
    expect(directionWords(0, 0, 1)).toBe("front");
    expect(directionWords(-0.6, 0.5, 0.6)).toBe("front, left, from above");
    expect(directionWords(0.1, -0.99, 0)).toBe("from below");
  });

  it("sliders give back what they show", () => {
    const base = { id: "", label: "", hint: "", show: String, get: () => 0, set: () => {} };
    for (const isLogarithmic of [true, false]) {
      const setting = { ...base, low: 1, high: 1000, isLogarithmic };
      for (let at = 0; at <= 60; at += 6) {
        expect(Math.abs(positionOf(setting, valueAt(setting, at)) - at)).toBeLessThanOrEqual(1);
        const withZero = { ...setting, hasZero: true };
        expect(Math.abs(positionOf(withZero, valueAt(withZero, at)) - at)).toBeLessThanOrEqual(1);
      }
      expect(valueAt({ ...setting, hasZero: true }, 0)).toBe(0);
    }
    const whole = { ...base, low: 0, high: 10, isLogarithmic: false, isWhole: true };
    for (let n = 0; n <= 10; n++) expect(valueAt(whole, positionOf(whole, n))).toBe(n);
  });

  it("names pictures so that every system takes them", () => {
    expect(fileName("Büste / Kopf: №1")).toMatch(/^Bu-ste-Kopf|^Buste-Kopf/);
    expect(fileName("../..")).toBe("picture");
  });
});
