/** The sheet of a scene's light: whether it shines, how its shadows are looked up, and of a sun's path the time. */
import type { LightInfo } from "../format/light";
import { filtersOf } from "../scene/light/look";
import type { App } from "./app";
import { make } from "./dom";
import type { LightControl } from "./light";
import { clockOf } from "./lightChoice";
import { Sheet } from "./sheet";
import { FILTER_NAMES, LIGHT_NAMES, WORDS } from "./words";

/** @param control - Of a light whose file is opened. */
export function makeLightPanel(app: App, control: LightControl): Sheet {
  const sheet = new Sheet("light", WORDS.light);
  const info = control.info!;
  sheet.add(make("p", { class: "about" }, aboutOf(info)));
  sheet.addSwitch({
    name: WORDS.ownLight,
    get: () => app.state.light.isOn,
    set: (isOn) => control.choose({ isOn }),
  });
  const { minutes } = info;
  if (minutes && minutes.length > 1) {
    sheet.addSlider({
      id: "time",
      label: WORDS.timeOfDay,
      hint: "",
      low: Math.ceil(minutes[0]!),
      high: Math.floor(minutes.at(-1)!),
      isLogarithmic: false,
      isWhole: true,
      show: clockOf,
      get: () => control.minutes,
      set: (value) => control.choose({ minutes: value, isOn: true }),
    });
  }
  sheet.addSelection({
    id: "filter",
    label: WORDS.edges,
    options: filtersOf(info).map((filter) => [filter, FILTER_NAMES[filter]] as const),
    get: () => control.filter,
    set: (filter) => control.choose({ filter }),
  });
  sheet.addReset(WORDS.sceneLight, () => control.reset());
  return sheet;
}

/** E.g. "Sunlight of 21 June 2026, 15:00. 65,536 × 65,536 pixels." */
function aboutOf({ name, begin, end, levels, images }: LightInfo): string {
  const when = [begin ? dayOf(begin) : "", hourOf(begin), hourOf(end)];
  const words = [when[0], [when[1], when[2]].filter(Boolean).join(" to ")].filter(Boolean).join(", ");
  const side = (2 ** levels).toLocaleString("en");
  const maps = images > 1 ? `${images} maps of ` : "";
  return `${LIGHT_NAMES[name] ?? WORDS.light}${words ? `, ${words}` : ""}. ${maps}${side} × ${side} pixels.`;
}

function dayOf(iso: string): string {
  const day = new Date(`${iso.slice(0, 10)}T12:00:00Z`);
  const options = { day: "numeric", month: "long", year: "numeric", timeZone: "UTC" } as const;
  return Number.isNaN(day.getTime()) ? "" : day.toLocaleDateString("en-GB", options);
}

function hourOf(iso: string | null): string {
  return iso?.slice(11, 16) ?? "";
}
