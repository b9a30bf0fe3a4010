/** The page: scene and tools put together. */
import type { Problem } from "../format/problem";
import type { Cage } from "../refine/cage";
import { defaultBudgets, deviceHints } from "../scene/device";
import { UP } from "../scene/frame";
import { type Part, Stage } from "../scene/stage";
import type { Asset } from "../stream/asset";
import type { DecoderPool } from "../stream/pool";
import { Streamer } from "../stream/streamer";
import { Address } from "./address";
import type { Stats } from "./api";
import { makeHelp } from "./dialogs";
import { byId } from "./dom";
import { watchPointer, watchWheel } from "./gestures";
import { watchKeys } from "./keyboard";
import type { LightControl } from "./light";
import { showViews } from "./namedViews";
import { announce, note, showWarning } from "./notices";
import { openLight } from "./openLight";
import { settingsOf } from "./ownSettings";
import type { RefinementControl } from "./refinement";
import type { SceneFile } from "./sceneFile";
import { makeSettings } from "./settings";
import { copyLink, savePicture } from "./sharing";
import type { Sheet } from "./sheet";
import { INITIAL, type State } from "./state";
import { figuresOf, statsOf, sumOf } from "./stats";
import { StatusLine } from "./statusLine";
import { subtitleOf } from "./subtitle";
import { applyTheme, backgroundOf, onDeviceTheme, resolveTheme } from "./theme";
import { type Tool, Toolbar } from "./toolbar";
import { makeTools } from "./tools";
import { WORDS } from "./words";

const stillQuery = matchMedia("(prefers-reduced-motion: reduce)");

export class App {
  readonly stage: Stage;
  readonly #streamer: Streamer;
  readonly #status: StatusLine;
  readonly #toolbar: Toolbar;
  readonly #tools: readonly Tool[];
  readonly #help = makeHelp();
  /** Of layers that are refined where they are looked at, if there are any. */
  refinement: RefinementControl | undefined;
  /** Of the scene's light, if it has one. */
  light: LightControl | undefined;
  #settings: Sheet | undefined;
  #state: State = INITIAL;
  readonly #address = new Address(
    () => (this.stage.layers.length ? this.state : null),
    (state) => this.#goTo(state),
  );
  #lostStrip: HTMLElement | undefined;
  #frames = 0;
  #hasColours = false;
  #firstPicture: (() => void) | undefined;
  #noPicture: ((problem: Problem) => void) | undefined;
  /** Settles with the first picture; fails if there can be none. */
  readonly firstPicture = new Promise<void>((resolve, reject) => {
    this.#firstPicture = resolve;
    this.#noPicture = reject;
  });

  /** @throws Problem if the browser has no WebGL2. */
  constructor(
    private readonly scene: SceneFile,
    pool: DecoderPool,
  ) {
    const budgets = defaultBudgets(deviceHints());
    this.stage = new Stage(byId("picture"), {
      errorPx: budgets.errorPx,
      triangleBudget: budgets.triangles,
      isStill: stillQuery.matches,
      onFrame: () => this.#onFrame(),
      onLost: () => this.#onLost(),
      onRestored: () => this.#onRestored(),
    });
    this.#streamer = new Streamer({
      pool,
      budgetBytes: budgets.bytes,
      onChange: () => this.stage.invalidate(),
      onProblem: (problem, { node }) => this.#onProblem(problem, node),
    });
    this.#status = new StatusLine(() => this.change({ isStatusOn: false }));
    this.#tools = makeTools(this);
    this.#toolbar = new Toolbar(byId("tools"), this.#tools);
    document.title = scene.title;
    byId("title").textContent = scene.title;
    byId("picture").setAttribute("aria-label", WORDS.canvas(scene.title));
    byId("instructions").textContent = WORDS.instructions;
    this.#applyState();
    this.#listen();
  }

  get state(): State {
    return { ...this.#state, camera: this.stage.navigation.getCamera() };
  }

  get help(): HTMLDialogElement {
    return this.#help;
  }

  /** Show the scene's layers; settles when all are opened. */
  async open(opening: Promise<readonly (Asset | Cage)[]>): Promise<void> {
    const opened = await opening;
    const parts = await this.#partsOf(opened);
    this.stage.open(this.#streamer, parts);
    void openLight(this, this.scene.light);
    this.stage.navigation.setUp(UP[opened[0]!.info.up]);
    this.stage.navigation.home(false);
    this.#applyState();
    this.#address.read();
    byId("subtitle").textContent = subtitleOf(opened.map(({ info }) => info));
    showViews(this.scene.views, (camera) => this.stage.setCamera(camera, true));
    this.#toolbar.update();
    if (this.stage.layers.some((layer) => layer.isWholeFile)) note(WORDS.wholeFile);
    this.stage.invalidate();
  }

  async #partsOf(opened: readonly (Asset | Cage)[]): Promise<Part[]> {
    if (opened.some((one) => "refinement" in one)) {
      const { RefinementControl } = await import("./refinement");
      this.refinement = new RefinementControl(this);
    }
    return opened.map((one, i) => {
      const { name, isVisible } = this.scene.layers[i]!;
      if ("refinement" in one) return this.refinement!.partOf(one, name, isVisible);
      return { asset: one, name, isVisible };
    });
  }

  /** Change part of the state and show it. */
  change(change: Partial<State>): void {
    this.#state = { ...this.#state, ...change };
    this.#applyState();
    this.#address.writeSoon();
  }

  home(): void {
    this.stage.navigation.home(true);
    this.stage.invalidate();
    announce(WORDS.home);
  }

  /** y, z, x and round again. */
  turnUp(): void {
    const next = { y: "z", z: "x", x: "y" } as const;
    const axis = next[this.upName()];
    this.stage.navigation.setUp(UP[axis]);
    this.stage.navigation.home(false);
    this.stage.invalidate();
    this.#toolbar.update();
    announce(WORDS.upAxis(axis.toUpperCase()));
  }

  /** The axis nearest to up. */
  upName(): "x" | "y" | "z" {
    const up = this.stage.navigation.camera.up.toArray().map(Math.abs);
    return (["x", "y", "z"] as const)[up.indexOf(Math.max(...up))] ?? "y";
  }

  /** Turn about the point under this place of the page from now on. */
  setPivot(clientX: number, clientY: number): void {
    const point = this.stage.pick(clientX, clientY);
    if (point) this.stage.navigation.focus(point);
    announce(point ? WORDS.pivot : WORDS.nothingThere);
    this.stage.invalidate();
  }

  toggleLayer(index: number): void {
    const { toggledLayers } = this.#state;
    const isToggled = toggledLayers.includes(index);
    this.change({
      toggledLayers: isToggled
        ? toggledLayers.filter((i) => i !== index)
        : [...toggledLayers, index].sort((a, b) => a - b),
    });
  }

  async savePicture(): Promise<void> {
    await savePicture(await this.stage.screenshot(), this.scene.title);
    note(WORDS.pictureSaved);
  }

  async copyLink(): Promise<void> {
    this.#address.write();
    await copyLink(location.href);
  }

  async toggleFullscreen(): Promise<void> {
    if (document.fullscreenElement) await document.exitFullscreen();
    else await document.documentElement.requestFullscreen?.();
  }

  toggleTheme(): void {
    const theme = resolveTheme(this.#state.theme) === "dark" ? "light" : "dark";
    this.change({ theme });
    announce(WORDS.themeIs(theme));
  }

  openSettings(): void {
    this.#settings ??= makeSettings(settingsOf(this));
    this.#settings.open();
  }

  setErrorPx(errorPx: number): void {
    this.change({ errorPx });
  }

  setBudgets({ triangles, bytes }: { triangles?: number; bytes?: number }): void {
    if (triangles !== undefined) this.stage.triangleBudget = triangles;
    if (bytes !== undefined) this.#streamer.budgetBytes = bytes;
    this.stage.invalidate();
  }

  stats(): Stats {
    return statsOf(this.stage, this.#streamer, this.#refined, this.#frames);
  }

  /** There can be no picture; after the first one this changes nothing. */
  fail(problem: Problem): void {
    this.#noPicture?.(problem);
  }

  get #refined(): ReturnType<typeof sumOf> {
    return sumOf(this.refinement?.layers.map((layer) => layer.figures) ?? []);
  }

  #goTo(state: State): void {
    this.#state = state;
    if (state.camera) this.stage.setCamera(state.camera);
    this.#applyState();
  }

  #applyState(): void {
    const { stage } = this;
    const state = this.#state;
    stage.look = { ...state, background: backgroundOf(state.background, state.theme, this.scene.background) };
    stage.targetPx = state.errorPx ?? defaultBudgets(deviceHints()).errorPx;
    stage.layers.forEach((layer, i) => {
      layer.group.visible = this.scene.layers[i]!.isVisible !== state.toggledLayers.includes(i);
    });
    this.refinement?.apply();
    this.light?.apply();
    applyTheme(state.theme);
    this.#status.isShown = state.isStatusOn;
    this.#toolbar.update();
    stage.invalidate();
  }

  #listen(): void {
    onDeviceTheme(() => this.#applyState());
    stillQuery.addEventListener("change", () => {
      this.stage.isStill = stillQuery.matches;
    });
    addEventListener("online", () => {
      this.#streamer.retry();
      this.refinement?.retry();
      this.light?.retry();
    });
    document.addEventListener("fullscreenchange", () => this.#toolbar.update());
    watchKeys(this, this.#tools);
    watchPointer(this.stage, (x, y) => this.setPivot(x, y));
    watchWheel(this.stage);
  }

  #onFrame(): void {
    this.#frames++;
    const { stage } = this;
    if (stage.moments.firstPicture !== undefined) this.#firstPicture?.();
    const hasColours = stage.layers.some((layer) => layer.hasColours);
    if (hasColours !== this.#hasColours) this.#toolbar.update(); // a refinement tells with its first message
    this.#hasColours = hasColours;
    this.#status.update(figuresOf(stage, this.#streamer, this.#refined));
    const progress = byId("progress");
    if (stage.layers.length) progress.hidden = stage.isIdle;
    if (stage.isIdle) this.#address.writeSoon();
  }

  /** Without its first node an asset cannot be shown at all; without any other it is only coarser. */
  #onProblem(problem: Problem, node: number): void {
    const isFatal = node === 0 && this.stage.moments.firstPicture === undefined;
    if (isFatal) this.fail(problem);
    else showWarning(problem.message, () => this.#streamer.retry());
  }

  #onLost(): void {
    this.#lostStrip = showWarning(WORDS.lost);
  }

  #onRestored(): void {
    this.#lostStrip?.remove();
    note(WORDS.restored);
  }
}
