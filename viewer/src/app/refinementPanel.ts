/** The sheet of a refinement: how fine it is where, what it may cost, and how it is shown. */
import { CATMULL_CLARK, MOST_DEPTH } from "../format/cage";
import { LEVELS } from "../scene/palette";
import type { App } from "./app";
import { make } from "./dom";
import type { RefinementControl } from "./refinement";
import { type RefinementChoice, RULES, rulesOf } from "./refinementChoice";
import { Sheet } from "./sheet";
import type { NumberSetting } from "./slider";
import { RULE_NAMES, SCHEME_NAMES, WORDS } from "./words";

/** More are never needed: 3^10 triangles for each of the control mesh. */
const MOST_ITERATIONS = 10;

export function makeRefinementPanel(app: App, control: RefinementControl): Sheet {
  const sheet = new Sheet("refinement", WORDS.refinement);
  sheet.add(make("p", { class: "about" }, aboutOf(control)));
  addColours(sheet, app, control);
  const schemes = new Set(control.cages.map(({ refinement }) => refinement.scheme));
  if (schemes.has(CATMULL_CLARK)) addPatches(sheet, control);
  if (schemes.size > 1 || !schemes.has(CATMULL_CLARK)) addRegions(sheet, control);
  else for (const setting of costsOf(control)) sheet.addSlider(setting);
  sheet.addSwitch({ name: WORDS.inset, get: () => control.isInsetOn, set: () => control.toggleInset() });
  sheet.addReset("Back to the scene's own", () => control.reset());
  return sheet;
}

function addRegions(sheet: Sheet, control: RefinementControl): void {
  sheet.addHeading("Where the surface faces the eye");
  for (const setting of frontOf(control)) sheet.addSlider(setting);
  sheet.addHeading("On the silhouette");
  for (const setting of silhouetteOf(control)) sheet.addSlider(setting);
  sheet.addHeading("Everywhere");
  for (const setting of [bendOf(control), ...costsOf(control)]) sheet.addSlider(setting);
  sheet.addSelection({
    id: "positions",
    label: "Vertices",
    options: [
      ["control", "Control points"],
      ["limit", "On the limit surface"],
    ],
    get: () => control.wants.positions,
    set: (positions) => control.choose({ positions }),
  });
}

function aboutOf({ cages }: RefinementControl): string {
  return cages
    .map(({ refinement, info }) =>
      info.polygons === undefined
        ? `${SCHEME_NAMES[refinement.scheme]} of ${info.triangles.toLocaleString("en")} triangles.`
        : `${SCHEME_NAMES[refinement.scheme]} of ${info.polygons.toLocaleString("en")} faces.`,
    )
    .join(" ");
}

function addColours(sheet: Sheet, app: App, { cages }: RefinementControl): void {
  // √3 triangles and those of patches are all green
  const isRgb = cages.some(({ refinement }) => ["loop", "butterfly"].includes(refinement.scheme));
  const hasTriplet = isRgb || app.state.faceColours === "triplet";
  const legend = make("div", { class: "legend", role: "img", "aria-label": "Levels from light to dark" });
  for (const [level, colour] of LEVELS.entries()) {
    const last = level === LEVELS.length - 1 ? "+" : "";
    const swatch = make("span", {}, `${level}${last}`);
    swatch.style.setProperty("--swatch", `rgb(${colour.join(" ")})`); // as an attribute the page's policy forbids it
    legend.append(swatch);
  }
  sheet.addSelection({
    id: "faces",
    label: "Colours",
    options: [
      ["plain", "None"],
      ["levels", "By level"],
      ...(hasTriplet ? [["triplet", "Green, red, blue"] as const] : []),
    ],
    get: () => app.state.faceColours,
    set: (faceColours) => {
      app.change({ faceColours });
      sheet.refresh();
    },
  });
  sheet.onRefresh(() => {
    legend.hidden = app.state.faceColours !== "levels";
  });
  sheet.add(legend);
}

type NumberKey = Exclude<keyof RefinementChoice, "positions" | "radiusPx" | "rules">;

function iterations(
  control: RefinementControl,
  id: NumberKey,
  label: string,
  get: () => number,
): NumberSetting {
  return {
    id,
    label,
    hint: "",
    low: 0,
    high: MOST_ITERATIONS,
    isLogarithmic: false,
    isWhole: true,
    show: (value) => (value === 0 ? "none" : `at most ${value}`),
    get,
    set: (value) => control.choose({ [id]: value }),
  };
}

function edges(control: RefinementControl, id: NumberKey, label: string, get: () => number): NumberSetting {
  return {
    id,
    label,
    hint: "",
    low: 1,
    high: 100,
    isLogarithmic: true,
    hasZero: true,
    show: (value) => (value === 0 ? "as fine as can be" : `${value} px`),
    get,
    set: (value) => control.choose({ [id]: value }),
  };
}

function frontOf(control: RefinementControl): NumberSetting[] {
  const front = () => control.wants.criteria.front;
  return [
    iterations(control, "frontIterations", "Iterations", () => front().iterations),
    edges(control, "frontPx", "Edge length", () => front().edge_px),
  ];
}

function silhouetteOf(control: RefinementControl): NumberSetting[] {
  const silhouette = () => control.wants.criteria.silhouette;
  return [
    iterations(control, "silhouetteIterations", "Iterations", () => silhouette().iterations),
    edges(control, "silhouettePx", "Edge length", () => silhouette().edge_px),
  ];
}

/** How deep patches are: a rule each, which can be left out. */
function addPatches(sheet: Sheet, control: RefinementControl): void {
  const rules = () => control.wants.depths;
  sheet.addHeading("How deep patches are");
  sheet.addSlider({
    ...iterations(control, "frontIterations", "Depth", () => rules().most),
    high: MOST_DEPTH,
  });
  sheet.addSlider({
    ...bendOf(control),
    label: "Curvature",
    hint: "So deep that normals around a vertex are within this angle.",
    get: () => rules().cone_degrees ?? 0,
  });
  sheet.addSlider({
    id: "radius",
    label: "Largest radius",
    hint: "Pieces of a patch are no larger on the picture.",
    low: 1,
    high: 200,
    isLogarithmic: true,
    show: (value) => `${Number(value.toPrecision(2))} px`,
    get: () => rules().size_px?.[1] ?? 24,
    set: (radiusPx) => control.choose({ radiusPx }),
  });
  sheet.addSwitches(
    "Rules",
    RULES.map((rule) => ({
      name: RULE_NAMES[rule],
      get: () => rulesOf(rules()).includes(rule),
      set: (is: boolean) => {
        const others = rulesOf(rules()).filter((one) => one !== rule);
        control.choose({ rules: RULES.filter((one) => (one === rule ? is : others.includes(one))) });
      },
    })),
  );
}

function bendOf(control: RefinementControl): NumberSetting {
  return {
    id: "bend",
    label: "Bend",
    hint: "Where the surface bends less, nothing is split.",
    low: 0,
    high: 30,
    isLogarithmic: false,
    show: (value) => (value === 0 ? "any" : `${Number(value.toPrecision(3))}°`),
    get: () => (control.wants.criteria.front.bend * 180) / Math.PI,
    set: (bendDegrees) => control.choose({ bendDegrees }),
  };
}

function costsOf(control: RefinementControl): NumberSetting[] {
  return [
    {
      id: "refined-triangles",
      label: "Triangles at most",
      hint: "To keep this, edges get longer than wanted.",
      low: 1000,
      high: 2e6,
      isLogarithmic: true,
      show: (value) => Number(value.toPrecision(2)).toLocaleString("en"),
      get: () => control.wants.budget,
      set: (budget) => control.chooseForDevice({ budget }),
    },
    {
      id: "rate",
      label: "Frames a second",
      hint: "",
      low: 5,
      high: 60,
      isLogarithmic: false,
      hasZero: true,
      show: (value) => (value === 0 ? "as they come" : `at least ${Math.round(value)}`),
      get: () => control.wants.rate,
      set: (rate) => control.chooseForDevice({ rate: Math.round(rate) }),
    },
  ];
}
