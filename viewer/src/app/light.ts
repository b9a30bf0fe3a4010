/** The light of a scene: its file, what the visitor chose of it, and its panel. Loaded where a scene has one. */
import type { LightInfo } from "../format/light";
import { sentenceOf } from "../format/problem";
import { filtersOf, type ShadowFilter } from "../scene/light/look";
import type { SceneLight } from "../scene/light/sceneLight";
import { openShadow, type ShadowFile, ShadowLoad } from "../stream/shadowFile";
import type { ShadowStage } from "../stream/shadowStage";
import type { App } from "./app";
import { addKeys } from "./dialogs";
import { imageAt, type LightChoice, NO_LIGHT_CHOICE } from "./lightChoice";
import { makeLightPanel } from "./lightPanel";
import { showWarning } from "./notices";
import type { SceneLightFile } from "./sceneFile";
import type { Sheet } from "./sheet";
import { LIGHT_KEYS } from "./words";

export class LightControl {
  #file: ShadowFile | undefined;
  #load: ShadowLoad | undefined;
  #panel: Sheet | undefined;
  #phase: "idle" | "opening" | "open" | "failed" = "idle";

  constructor(
    private readonly app: App,
    private readonly asked: SceneLightFile,
  ) {
    addKeys(app.help, LIGHT_KEYS);
  }

  /** What the file says, once it is opened. */
  get info(): LightInfo | undefined {
    return this.#file?.light;
  }

  get filter(): ShadowFilter {
    const { filter } = this.app.state.light;
    const has = this.info ? filtersOf(this.info) : [];
    if (filter && has.includes(filter)) return filter;
    return has.includes("soft") ? "soft" : "3x3";
  }

  /** Of a sun's path, the time that is shown. */
  get minutes(): number {
    const times = this.info?.minutes ?? [0];
    const middle = times[Math.floor((times.length - 1) / 2)]!;
    return Math.max(times[0]!, Math.min(times.at(-1)!, this.app.state.light.minutes ?? middle));
  }

  /** Do what the state says; what is not looked at is not fetched. */
  apply(): void {
    const { stage, state } = this.app;
    if (state.light.isOn && this.#phase === "idle") void this.#open();
    stage.isLightComing = this.#phase === "opening" || this.#load?.isSettled === false;
    stage.invalidate(); // also if there will be none: who waits for it may go on
    if (!stage.light) return;
    stage.light.look = { isOn: state.light.isOn, filter: this.filter, time: this.#image };
  }

  /** Of a sun's path that of the time; of an area light one in its midst. */
  get #image(): number {
    const { minutes, images } = this.info!;
    return minutes ? imageAt(minutes, this.minutes) : Math.floor(images / 2);
  }

  choose(change: Partial<LightChoice>): void {
    this.app.change({ light: { ...this.app.state.light, ...change } });
  }

  reset(): void {
    this.app.change({ light: NO_LIGHT_CHOICE });
  }

  openPanel(): void {
    if (this.info) this.#panel ??= makeLightPanel(this.app, this);
    this.#panel?.open();
  }

  /** Try again what failed, e.g. when the network is back. */
  retry(): void {
    if (this.#phase === "failed") this.#phase = "idle";
    if (this.#load?.hasFailed) this.#load.start();
    this.apply();
  }

  async #open(): Promise<void> {
    this.#phase = "opening";
    try {
      const file = await openShadow(this.asked.url);
      const light = this.app.stage.shine(file.light, this.asked.moving);
      this.#file = file;
      this.#load = new ShadowLoad(file, {
        onStage: (stage) => this.#take(light, stage),
        onEnd: () => this.apply(),
        onProblem: (problem) => this.#fail(problem),
      });
      this.#load.start();
      this.#phase = "open";
    } catch (error) {
      this.#phase = "failed";
      this.#fail(error);
    }
    this.apply();
  }

  #take(light: SceneLight, stage: ShadowStage): void {
    try {
      light.take(stage);
    } catch (error) {
      this.#fail(error); // too large for these graphics: the map before stays
    }
    this.app.stage.invalidate();
  }

  /** The scene is there without its shadows. */
  #fail(error: unknown): void {
    showWarning(sentenceOf(error), () => this.retry());
  }
}
